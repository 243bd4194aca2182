# The first 45 s of tests/linuxcnc/patch.sh on LinuxCNC, where the wheel is lifted while it cuts and falls on ridges between two readings:
# the coefficient within 2 %, the exponent of the force within .02. Reference: the law of the simulated head, .7 times the job's coefficient.
# With the strokes' whole volumes the coefficient is 5 % too large, the exponent .87.
fettle-part "$SAMPLES/parts/wang3.json" > part.stl
jq '.anomaly = [[0.65, 0.7, 0.9], [1.4, 0.7, 0.9], [1.4, 1.45, 0.9], [0.65, 1.45, 0.9]] | .safe_height = 1.6 |
    .sampling = [[0.3, 0.3, 0.6], [1.9, 0.3, 0.6], [1.9, 1.9, 0.6], [0.3, 1.9, 0.6]]' "$SAMPLES/jobs/wang3.json" > job.json
fettle-calibrate "$HERE/linuxcnc.pcd" --job job.json --before part.stl --report law.json > learnt.json
jq -e --slurpfile job job.json '(.gantry.coefficient / (0.7 * $job[0].removal.coefficient * pow(25.4; 3) / 4.4482216152605) - 1 | fabs) < 0.02' law.json > ok
jq -e '.parameters[] | select(.name == "force") | (.mean - 1 | fabs) < 0.02 and .determined == "measured"' law.json > ok
# A stock covers the anomaly, not the sampling area; it is a part as good as any other.
fettle-part --without-anomaly "$SAMPLES/parts/wang3.json" > desired.stl
jq '.removal.coefficient *= 10' job.json > soft.json
fettle-sample soft.json --on desired.stl | fettle-fit soft.json | fettle-plan soft.json | fettle-grind - --stock part.stl --gantry virtual --trace trace.pcd > ground.pcd
fettle-calibrate trace.pcd --job soft.json --before part.stl --after ground.pcd > learnt.json 2> warnings
cat warnings
[ ! -s warnings ]

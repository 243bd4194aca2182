# A patch of 0.75 x 0.75 in of Wang's part 3, ground on LinuxCNC and on the virtual gantry by the same strategy: at 99 of 100 places of
# the patch the surfaces differ by at most 0.05 mm. Around it, where the wheel runs out, the walls that are left depend on how often it
# has been there. Reference: the virtual gantry's stock; LinuxCNC's is what lay under its head.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
fettle-part "$SAMPLES/parts/wang3.json" > part.stl
fettle-part --without-anomaly "$SAMPLES/parts/wang3.json" > desired.stl
jq '.anomaly = [[0.65, 0.7, 0.9], [1.4, 0.7, 0.9], [1.4, 1.45, 0.9], [0.65, 1.45, 0.9]] | .safe_height = 1.6 |
    .sampling = [[0.3, 0.3, 0.6], [1.9, 0.3, 0.6], [1.9, 1.9, 0.6], [0.3, 1.9, 0.6]]' "$SAMPLES/jobs/wang3.json" > job.json
fettle-sample job.json --on desired.stl | fettle-fit job.json | fettle-plan job.json > plan.json
# The material is removed .7 times as easily as the job says.
jq '.job.removal.coefficient *= 0.7' plan.json > hidden.json
fettle-stock-linuxcnc hidden.json --stock part.stl > before
start before
fettle-grind plan.json --stock part.stl --layer-1 feed --gantry "exec:$(driver plan.json)" --trace trace.pcd --report driven.json -v > seen.pcd
stop
fettle-stock-linuxcnc hidden.json --stock part.stl --after machine/run/stock.ground --ascii > ground.pcd
fettle-grind plan.json --stock part.stl --layer-1 feed --gantry virtual --removal-factor 0.7 --report virtual.json --ascii > virtual.pcd
jq -c '[.finished, .machine_time, .layers, .raises, .re_cuts, .strokes, .steps, .peak_force, .removed_volume]' driven.json virtual.json
jq -e '.finished' driven.json > finished
points() { sed '1,/^DATA/d' "$1"; }
differences() { # CONDITION on $1 (x) and $2 (y): of z, mm, ascending
    paste -d ' ' <(points ground.pcd) <(points virtual.pcd) |
        awk '$1 != $5 || $2 != $6 { exit 1 } '"$1"' { d = ($3 - $7) * 25.4; print d < 0 ? -d : d }' | sort -g
}
statistics() { awk '{ d[NR] = $1 } END { printf "%d places: median %.4f, 99th percentile %.4f, largest %.4f mm\n", NR, d[int(NR / 2)], d[int(NR * 0.99)], d[NR] }'; }
differences 1 | statistics
differences '$1 > 0.65 && $1 < 1.4 && $2 > 0.7 && $2 < 1.45' > patch
statistics < patch
awk '{ d[NR] = $1 } END { exit !(NR > 10000 && d[int(NR * 0.99)] <= 0.05) }' patch
# From the trace and the part before and after come the coefficient and the exponent of the law that the head obeys.
fettle-calibrate trace.pcd --job job.json --before part.stl --after ground.pcd --report law.json > learnt.json
jq -c '[.gantry.coefficient, (.parameters[] | select(.name == "force") | .mean)]' law.json
jq -e --slurpfile job job.json '(.gantry.coefficient / (0.7 * $job[0].removal.coefficient * pow(25.4; 3) / 4.4482216152605) - 1 | fabs) < 0.05' law.json > ok
jq -e '.parameters[] | select(.name == "force") | (.mean - 1 | fabs) < 0.1' law.json > ok

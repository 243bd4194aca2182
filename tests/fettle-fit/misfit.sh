# A boundary that leaves out the ends of the bead: touches on it. The fit says that they lie farther off than the probe's accuracy
# explains; with the boundary around all of it there is no warning. Reference: the part, which is known.
part=$SAMPLES/parts/hammer.json
job=$SAMPLES/jobs/hammer.json
fettle-part "$part" > worn.stl
jq '.anomaly = [[-20, -3], [8, -3], [8, 3], [-20, 3]]' "$job" > small.json
fettle-sample small.json --on worn.stl --noise normal:0.127 | fettle-fit small.json > surface.json 2> message
[ "$(wc -l < message)" -eq 1 ]
grep -F 'fettle-fit: warning: stdin: the touches lie' message
for seed in 1 2 3 4 5 6 7 8; do
    fettle-sample "$job" --on worn.stl --noise normal:0.127 --seed $seed | fettle-fit "$job" > surface.json 2> message
    [ ! -s message ]
done

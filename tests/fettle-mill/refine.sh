# Adaptive refinement: a grid of 0.4 mm whose steep squares are halved three times has its walls where a grid of 0.05 mm has
# them; without, the walls lean over a whole cell. A ball makes a trench, a flat cutter a slot askew. Reference: the finer grid.
printf 'G0 X-6 Y4 Z-2\nG1 X26 Y9 F600\nG0 Z5\nX5 Y17\nG1 Z-3.2\nX15\nG0 Z5\n' > path.nc
mill() { fettle-mill path.nc --stock box:0,0,-6,20,20,0 --cutter "$cutter" -q "$@" || test $? = 1; }
for cutter in flat:4 ball:4; do
    mill --step 0.05 -o fine.stl
    mill --step 0.4 -o coarse.stl
    mill --step 0.4 --refine 3 -o refined.stl --report refined.json
    jq -e '.refined_squares > 100 and .step == 0.4' refined.json > ok
    for part in coarse refined; do fettle-compare fine.stl --to $part.stl --report $part.json --tolerance 9 > errors.pcd; done
    # what is left are squares that a cut reaches into by less than their steepness shows
    jq -e --slurpfile coarse coarse.json '.rms < 0.4 * $coarse[0].rms' refined.json > ok
done
for n in 1 2; do mill --step 0.4 --refine 2 --threads $n -o $n.stl; done
cmp 1.stl 2.stl

# Four virtual scans of the hammer, each in a frame of its own, come together in any order; one of another part is thrown out by name.
# Reference: the poses that the scans were made with (views/N.txt), and the mesh that they were made of. Their noise is 0.03 mm.
cp -r "$SAMPLES/scans/views" .
fettle-place "$SAMPLES/scans/panel.pcd" --units mm --centre -o panel.pcd
fettle-clean panel.pcd --crop sphere:0,0,0,40 -o foreign.pcd
status=0
fettle-merge views/2.pcd foreign.pcd views/1.pcd views/4.pcd views/3.pcd --report poses.json -o part.pcd 2>warnings || status=$?
[ $status -eq 1 ]
grep -q 'foreign.pcd: fits none of the other scans' warnings
jq -e '.kind == "poses" and .converged and .refused[0].scan == "foreign.pcd" and .scans[1].matrix == null' poses.json >ok
jq -e '[.scans[].noise | select(. > 0.015 and . < 0.04)] | length >= 4' poses.json >ok # along the beam .03: along the normal less
jq -e '[.pairs[] | select(.rms < 0.05)] | length >= 3' poses.json >ok

# Each pose, undone by the truth, is the first scan's: the product of the matrices moves no point of the part by more than 0.15 mm, five
# standard deviations of the least sure of them.
for n in 1 3 4; do
    jq -r --arg file "views/$n.pcd" '.scans[] | select(.file == $file) | .matrix[] | map(tostring) | join(" ")' poses.json >found.txt
    fettle-place views/$n.pcd --matrix found.txt -o found.pcd
    fettle-place found.pcd --matrix views/2.txt -o found-there.pcd
    fettle-place views/$n.pcd --matrix views/$n.txt -o true.pcd
    fettle-diff --tol 0.15 found-there.pcd true.pcd
done

# The part lies on the mesh, and nowhere else: holes stay open. At its edges the means of cubes 2 mm wide are off by more than the noise.
fettle-place part.pcd --matrix views/2.txt -o there.pcd
fettle-compare there.pcd --to "$SAMPLES/scans/hammer.stl" --report errors.json -o errors.pcd
jq -e '.undefined <= 5 and .p99 < 0.2 and .p01 > -0.2 and (.p50 | fabs) < 0.02' errors.json >ok

# Any number of threads writes the same bytes; from given poses no search, and the same poses.
fettle-merge views/[1-4].pcd --threads 1 -o one.pcd --report one.json
fettle-merge views/[1-4].pcd --threads 2 -o two.pcd --report two.json
cmp one.pcd two.pcd
cmp one.json two.json
fettle-merge views/[1-4].pcd --poses one.json --report again.json -o again.pcd
jq -e --slurpfile first one.json '[.scans, $first[0].scans] | transpose | all(.[0].centre as $a | .[1].centre as $b | [range(3) | ($a[.] - $b[.]) | fabs] | max < 0.02)' again.json >ok

# In metres.
for n in 2 3; do fettle-place views/$n.pcd --units m -o m$n.pcd; done
fettle-merge m2.pcd m3.pcd --report metres.json -o metres.ply
jq -e '.units.length == "m" and .scans[0].noise < 4e-5' metres.json >ok

# Touches that are not this job's: beside its sampling boundary, or far from the height of its boundary points. Reference: by hand.
source "$HERE/points.bash"
refuses=$HERE/../refuses
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"}, "probe": {"accuracy": 0.1},
  "anomaly": [[-10, -10, 5], [10, -10, 5], [10, 10, 5], [-10, 10, 5]],
  "sampling": [[-25, -25], [25, -25], [25, 25], [-25, 25]]}' >job.json
for line in -4 4; do
    for along in -24 -12 12 24; do printf '%s %s\n%s %s\n' $line $along $along $line; done
done | awk '{ print $1, $2, 5 - ($1 ^ 2 + $2 ^ 2) / 400, 1 }' >rows
moved() { awk -v dx="$1" -v dz="$2" '{ print $1 + dx, $2, $3 + dz, $4 }' rows | pcd x y z role | sed 1d; }
moved 0 0 >here.pcd
fettle-fit job.json here.pcd >here.json 2>message
[ ! -s message ]
# all of them, and half of them, lie outside: whatever comes first refuses them
moved 50 0 >there.pcd
outside='16 of 16 touches lie outside the job'"'s sampling boundary, the one at (74, -4) mm by 49 mm: are they this job's"
"$refuses" "there.pcd: $outside" fettle-fit job.json there.pcd
"$refuses" "there.pcd: 16 of 16 touches lie outside" fettle-fit job.json there.pcd --method plane
"$refuses" "there.pcd: 16 of 16 touches lie outside" fettle-estimate job.json there.pcd
moved 24 0 >half.pcd
"$refuses" 'half.pcd: 8 of 16 touches lie outside' fettle-fit job.json half.pcd
jq '(.anomaly, .sampling) |= map(.[0] += 50)' job.json >there.json
fettle-fit there.json there.pcd >surface.json
"$refuses" 'surface.json: 16 of 16 touches lie outside' fettle-margin job.json surface.json
"$refuses" 'surface.json: 16 of 16 touches lie outside' fettle-plan job.json surface.json
# a few lie outside: a warning; within the probe's accuracy none does
moved 5 0 >few.pcd
fettle-fit job.json few.pcd >few.json 2>message
grep -F 'few.pcd: 2 of 16 touches lie outside the job'"'"'s sampling boundary, the one at (29, -4) mm by 4 mm; they are used' message
moved 1.05 0 >edge.pcd
fettle-fit job.json edge.pcd >edge.json 2>message
[ ! -s message ]
# boundary points 50 mm off
moved 0 -50 >low.pcd
fettle-fit job.json low.pcd >low.json 2>message
grep -F "low.pcd: the job's boundary points lie 50" message
grep -F ' above the touches next to them' message
# where the fit takes them as touches, they are refused: the surface would be 2 mm off, by bspline 78 mm
jq '.sampling |= map(. + [5])' job.json >measured.json
"$refuses" "low.pcd: the job's boundary points lie 5" fettle-fit measured.json low.pcd -m griddata
"$refuses" "low.pcd: the job's boundary points lie 5" fettle-fit measured.json low.pcd -m bspline --use-boundary
fettle-fit measured.json low.pcd -m bspline -q >bspline.json
fettle-fit measured.json here.pcd -m griddata >griddata.json

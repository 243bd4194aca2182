# A 1 x 1 in anomaly in the middle of a 3 x 3 in boundary: 2 + 2 lines at the thirds of the anomaly's sides, touched
# where they cross both squares. Reference: Wang 2007, 4.4.4, 3, by hand. The touched plane is z = x/10 + y/10.
cat > job.json <<'JOB'
{"kind": "job", "units": {"length": "in"}, "surface": {"type": "freeform"}, "safe_height": 2,
 "anomaly": [[1, 1], [2, 1], [2, 2], [1, 2]], "sampling": [[0, 0], [3, 0], [3, 3], [0, 3]]}
JOB
cat > plane.stl <<'STL'
solid plane
facet normal 0 0 1
outer loop
vertex -1 -1 -0.2
vertex 9 -1 0.8
vertex -1 9 0.8
endloop
endfacet
endsolid plane
STL
fettle-sample job.json --on plane.stl --ascii --report report.json > samples.pcd
# curve, role, x, y, z
grep '^DATA' -A 16 samples.pcd | tail -n 16 | awk '{ printf "%d %d %.3f %.3f %.4f\n", $4, $5, $1, $2, $3 }' | sort
jq '.touches, .lines' report.json
# across at most along each line and between them; at least the outline of the crossings next to S
jq -e '.path_length > 8 and .path_length < 20 and .probing_time > 16 * 0.5' report.json > checked

# Samples from which no point can be estimated.
refuses=$HERE/../refuses
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"}, "anomaly": [[10, 10], [20, 10],
  [20, 20], [10, 20]], "sampling": [[0, 0], [30, 0], [30, 30], [0, 30]]}' > job.json
printf 'solid f\nfacet normal 0 0 1\nouter loop\nvertex -9 -9 0\nvertex 99 -9 0\nvertex -9 99 0\nendloop\nendfacet\nendsolid f\n' > part.stl
fettle-sample job.json --on part.stl --ascii > samples.pcd
: > empty
"$refuses" 'stdin' fettle-estimate job.json < /dev/null
"$refuses" 'empty' fettle-estimate job.json empty
"$refuses" 'part.stl' fettle-estimate job.json part.stl
"$refuses" 'job.json' fettle-estimate job.json job.json
echo '1 2 3' > one.xyz
"$refuses" "one.xyz: the points have no field 'curve'" fettle-estimate job.json one.xyz
fettle-estimate job.json samples.pcd > points.pcd
"$refuses" 'points.pcd: already has estimated points (role 3)' fettle-estimate job.json points.pcd
# a touch is missing; places without heights
awk '/^[0-9]/ && NF == 5 && !done { $3 = "nan"; done = 1 } { print }' samples.pcd > missing.pcd
"$refuses" 'missing.pcd: curve ' fettle-estimate job.json missing.pcd
fettle-sample job.json --plan-only > plan.pcd
"$refuses" 'plan.pcd: no touches of role 1 and 2' fettle-estimate job.json plan.pcd
# the header says mm, the user says inches
"$refuses" 'samples.pcd' fettle-estimate job.json samples.pcd --file-units in

# A job in inches, with the test in mm and the reference in m, and all in inches, agree but for float rounding.
cat >job.json <<'JSON'
{ "kind": "job", "units": {"length": "in", "force": "lbf"}, "surface": {"type": "freeform"},
  "anomaly": [[1, 1], [3, 1], [3, 3], [1, 3]], "sampling": [[0, 0], [4, 0], [4, 4], [0, 4]] }
JSON
printf 'v 0 0 0\nv 4 0 0\nv 4 4 1\nv 0 4 1\nf 1 2 3 4\n' >in.obj
printf 'v 0 0 0\nv 0.1016 0 0\nv 0.1016 0.1016 0.0254\nv 0 0.1016 0.0254\nf 1 2 3 4\n' >m.obj
for x in 1 1.5 2 2.5; do for y in 1 1.5 2 2.5; do echo "$x $y 0.5"; done; done >in.xyz
awk '{ print 25.4 * $1, 25.4 * $2, 25.4 * $3 }' in.xyz >mm.xyz
fettle-compare in.xyz --to in.obj --within job.json --tolerance 1 --report in.json -o in.pcd
fettle-compare mm.xyz --file-units mm --to m.obj --to-units m --within job.json --tolerance 1 --report mm.json -o mm.pcd
fettle-diff --tol 1e-6 in.pcd mm.pcd
fettle-diff --tol 1e-6 in.json mm.json
# The volume under the plane z = y / 4: sixteen cells of 0.5 x 0.5 in, seen from above.
fettle-compare in.xyz --to in.obj --within job.json --tolerance 1 --mode z --report z.json -o /dev/null
jq -e '(.under_cut_volume - .over_cut_volume - 0.25 * (4 * (0.25 + 0.125 + 0 - 0.125)) | fabs) < 1e-6' z.json >/dev/null

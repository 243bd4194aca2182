# With a job the statistics come by region too, in inches, and only B is judged. Reference: by hand.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n' >plate.obj
cat >job.json <<'JSON'
{ "kind": "job", "units": {"length": "in", "force": "lbf"}, "surface": {"type": "freeform"}, "tolerance": 0.1,
  "anomaly": [[4, 4], [6, 4], [6, 6], [4, 6]], "sampling": [[2, 2], [8, 2], [8, 8], [2, 8]] }
JSON
printf '5 5 0.05\n4.5 5.5 -0.0625\n3 3 0.25\n9 9 0.5\n9 11 0.5\n' >test.xyz
fettle-compare test.xyz --to plate.obj --within job.json --report report.json -o errors.pcd
jq -e '.count == 4 and .undefined == 1 and .judged == "inside" and .tolerance == 0.1 and
    .regions.inside.count == 2 and .regions.around.count == 1 and .regions.outside.count == 1 and
    .regions.outside.undefined == 1 and .regions.around.mean == 0.25 and .regions.inside.min == -0.0625' report.json >/dev/null
head -n 20 errors.pcd | grep -a -q '^# units in'
status=0
fettle-compare test.xyz --to plate.obj --within job.json --tolerance 0.06 -o /dev/null || status=$?
[ $status -eq 1 ]

# On request: the nearest point, its facet, the region. Reference: a plate of two facets, by hand.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3\nf 1 3 4\n' >plate.obj
cat >job.json <<'JSON'
{ "kind": "job", "units": {"length": "in", "force": "lbf"}, "surface": {"type": "freeform"}, "tolerance": 1,
  "anomaly": [[4, 4], [6, 4], [6, 6], [4, 6]], "sampling": [[2, 2], [8, 2], [8, 8], [2, 8]] }
JSON
printf '5 4.5 0.25\n3 7 -0.5\n9 9.5 0.5\n9 11 0.5\n' >test.xyz
fettle-compare test.xyz --to plate.obj --within job.json --fields foot,facet,region --format csv -o fields.csv
cut -d , -f 1-3,7-12 fields.csv
status=0
fettle-compare test.xyz --to plate.obj --fields region -o out 2>err || status=$?
[ $status -eq 2 ]
cat err
fettle-compare test.xyz --to plate.obj --fields feet -o out 2>err || cat err

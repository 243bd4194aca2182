# A ball of 2 mm radius touches a slope of 45 degrees: contacts lie on it, beside the planned places by R/sqrt(2). Without
# compensation they would be R (sqrt(2) - 1) = 0.83 mm too high. Reference: the facet's plane, z = x.
cat > job.json <<'JOB'
{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"},
 "anomaly": [[30, 30], [60, 30], [60, 60], [30, 60]], "sampling": [[10, 10], [90, 10], [90, 90], [10, 90]]}
JOB
printf 'solid f\nfacet normal -1 0 1\nouter loop\nvertex -50 -50 -50\nvertex 500 -50 500\nvertex -50 500 -50\nendloop\nendfacet\nendsolid f\n' > part.stl
fettle-sample job.json --on part.stl --tip 2 --ascii -q > samples.pcd
grep '^DATA' -A 99 samples.pcd | tail -n 16 | awk '{ d = $3 - $1; if (d > 1e-4 || d < -1e-4) exit 1 }'
min_x() { grep '^DATA' -A 99 | tail -n 16 | sort -g | head -n 1 | cut -d ' ' -f 1; }
[ "$(min_x < samples.pcd | xargs printf '%.3f')" = 8.586 ] || [ "$(min_x < samples.pcd | xargs printf '%.3f')" = 11.414 ]
# the job may name the tip
jq '.probe.tip_radius = 2' job.json > tip.json
fettle-sample tip.json --on part.stl --ascii -q | cmp samples.pcd -
"$HERE/../refuses" '--tip: must be at least 0, got -1' fettle-sample job.json --on part.stl --tip -1

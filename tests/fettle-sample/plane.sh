# On a plane the anomaly's boundary points are the touches: with the heights of the job, or probed again with --on. The
# part is one facet, z = 5 + x/10, exact.
job() { echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "plane"}, "anomaly": '"$1"'}'; }
job '[[0, 0, 5.1], [30, 0, 8.2], [30, 20, 8.1], [0, 20, 4.9]]' > with_z.json
job '[[0, 0], [30, 0, 8.2], [30, 20], [0, 20]]' > without_z.json
cat > part.stl <<'STL'
solid part
facet normal 0 0 1
outer loop
vertex -10 -10 4
vertex 90 -10 14
vertex -10 90 4
endloop
endfacet
endsolid part
STL
rows() { grep '^DATA' -A 4 | tail -n 4 | awk '{ print $1, $2, $3, $4, $5 }' | sort -n; }
fettle-sample with_z.json --ascii | rows
fettle-sample with_z.json --on part.stl --ascii | rows
fettle-sample without_z.json --on part.stl --ascii | rows
"$HERE/../refuses" 'without_z.json: touch points without z: name the part to touch, --on SURFACE' fettle-sample without_z.json
# a safe height that is none
jq '.safe_height = 6' with_z.json > low.json
fettle-sample low.json -o low.pcd 2> warning
grep -qF 'warning: safe_height 6 is below a touch at z 8.2' warning

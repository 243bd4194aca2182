# Twenty thousand times the same facet count as one, and take no longer. Reference: the distance to its plane.
facet=$'facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 3 0 0\nvertex 0 3 0\nendloop\nendfacet\n'
{ echo solid s; printf "$facet%.0s" {1..20000}; echo endsolid s; } >many.stl
for i in {0..99}; do for j in {0..99}; do echo "0.$i 0.$j 0.5"; done; done >points.xyz
timeout 60 fettle-compare points.xyz --to many.stl --report report.json >errors.pcd
jq -e '.count == 10000 and .undefined == 0 and .min == 0.5 and .max == 0.5' report.json
timeout 60 fettle-render many.stl >picture.png

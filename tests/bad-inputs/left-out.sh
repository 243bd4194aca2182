# Every tool that reads a mesh says what it left out of it: a facet with a corner that is NaN, vertices of no facet. One of which most would be
# left out is refused, and so is a robot whose body would not be whole. Reference: the meshes, made here.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/../robustness/tools.bash"
inputs
awk 'function corner(p) { printf "vertex %s\n", p } function facet(a, b, c) { print "facet normal 0 0 0"; print "outer loop"; corner(a); corner(b); corner(c); print "endloop"; print "endfacet" }
    function at(i, j) { return (4 * i - 10) " " (4 * j - 10) " " 5 + 0.2 * sin(i) }
    BEGIN { print "solid s"
        for (i = 0; i < 12; i++) for (j = 0; j < 12; j++) { facet(at(i, j), at(i + 1, j), at(i + 1, j + 1)); facet(at(i, j), at(i + 1, j + 1), (i || j ? at(i, j + 1) : "nan 0 0")) }
        print "endsolid s" }' >nan.stl
awk '/^vertex/ && ++n > 9 && n % 3 == 0 { $2 = "nan" } { print }' nan.stl >most.stl
{ echo "OFF"; echo "170 144 0"
  awk 'BEGIN { for (i = 0; i < 13; i++) for (j = 0; j < 13; j++) print 4 * i - 10, 4 * j - 10, 5 + 0.2 * sin(i); print 900, 0, 0
      for (i = 0; i < 12; i++) for (j = 0; j < 12; j++) print 4, 13 * i + j, 13 * (i + 1) + j, 13 * (i + 1) + j + 1, 13 * i + j + 1 }'; } >unused.off
jq '.bodies += [{"name": "guard", "link": 0, "shape": "hull", "file": "nan.stl"}]' robot.json >guarded.json

says() { # MESSAGE COMMAND…
    fettle-"${@:2}" >out 2>err </dev/null || [ $? = 1 ] || { cat err; exit 1; }
    grep -qF "$1" err || { echo "fettle-${*:2} does not say '$1'"; cat err; exit 1; }
}
# MESH is the mesh; the others are good.
while read -r -a words; do
    says 'warning: nan.stl: 1 facet with NaN or infinite corners left out' "${words[@]//MESH/nan.stl}"
    says 'warning: unused.off: 1 vertex of no facet left out' "${words[@]//MESH/unused.off}"
    command=("${words[@]//MESH/most.stl}")
    "$HERE/../refuses" '286 of 288 triangles have NaN or infinite corners' fettle-"${command[@]}"
done <<'COMMANDS'
align MESH --to plate.stl --near -o o.pcd
align plate.stl --to MESH --near -o o.pcd
clean MESH -o o.stl
collide robot.json tips.pcd --workpiece MESH -o o.pcd
compare good.pcd --to MESH -o o.pcd
compare MESH --to plate.stl -o o.pcd
find MESH --max-width 20 -o o.pcd
find good.pcd --against MESH --transform-in identity.txt -o o.pcd
finish MESH --cutter ball:6 --step-over 4 -o o.nc
form flatness MESH -o o.json
gantry-virtual plan.json --stock MESH --cell 0.5
grind plan.json --stock MESH --gantry virtual --cell 0.5 -o o.pcd
mill path.nc --stock MESH --cutter ball:6 --step 0.5 -o o.stl
place MESH --turn x,5 -o o.stl
render MESH -o o.png
report --before MESH --after good.pcd --job job.json -o o.html
sample job.json --on MESH -o o.pcd
stock-linuxcnc plan.json --stock MESH --cell 0.5 -o o
surfel MESH --stock plate.stl --spacing 4 -o o.pcd
surfel plate.stl --stock MESH --spacing 4 -o o.pcd
teach job.json --anomaly picked.txt --on MESH -o o.json
verify MESH --design plate.stl --step 4 -o o.pcd
verify plate.stl --design MESH --step 4 -o o.pcd
view MESH -o o.html
COMMANDS
"$HERE/../refuses" 'nan.stl: 1 of its facets have NaN or infinite corners: the body is not whole' fettle-collide guarded.json tips.pcd

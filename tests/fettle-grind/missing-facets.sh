# A closed block with facets whose vertices are no numbers: they are left out and counted. Where they leave a hole in the top over
# the anomaly, the inner side of the bottom is no surface, and the place is named. Inside out or not, it is the same block; where
# the winding is arbitrary, nothing is known of its sides, and the block is as it is seen from above. Reference: the block.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
block() { # HALF_HOLE [flip|random]: 40 x 40 mm, from z 0 to 5.3, with a hole in the top around the middle, 2 mm facets
    awk -v hole="$1" -v flip="${2:-}" 'function facet(a, b, c,  t) {
            if (flip == "flip" || (flip == "random" && ++n % 3 == 0)) { t = b; b = c; c = t }
            print "facet normal 0 0 0\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet" }
        function quad(a, b, c, d) { facet(a, b, c); facet(a, c, d) }
        BEGIN { print "solid block"
            for (x = -20; x < 20; x += 2) for (y = -20; y < 20; y += 2) {
                top = (x >= -hole && x < hole && y >= -hole && y < hole) ? "nan" : 5.3
                quad(x " " y " " top, x + 2 " " y " " top, x + 2 " " y + 2 " " top, x " " y + 2 " " top)
                quad(x " " y " 0", x " " y + 2 " 0", x + 2 " " y + 2 " 0", x + 2 " " y " 0") }
            for (x = -20; x < 20; x += 2) {
                quad(x " -20 0", x + 2 " -20 0", x + 2 " -20 5.3", x " -20 5.3"); quad(x " 20 0", x " 20 5.3", x + 2 " 20 5.3", x + 2 " 20 0")
                quad("-20 " x " 0", "-20 " x " 5.3", "-20 " x + 2 " 5.3", "-20 " x + 2 " 0"); quad("20 " x " 0", "20 " x + 2 " 0", "20 " x + 2 " 5.3", "20 " x " 5.3") }
            print "endsolid" }' > block.stl
}
removed() { fettle-grind plan.json --stock block.stl --cell 0.2 --report report.json > ground.pcd 2> message; jq .removed_volume report.json; }
for flip in '' flip random; do
    block 0 "$flip"
    whole=$(removed)
    [ ! -s message ]
    jq -e '.dropped_facets == 0' report.json > ok
    awk -v v="$whole" 'BEGIN { exit v < 0.2 * 144 || v > 0.5 * 14 * 32 }'
done
for flip in '' flip; do
    block 4 "$flip"
    "$HERE/../refuses" 'block.stl: no surface over ' fettle-grind plan.json --stock block.stl --cell 0.2
done
block 100 # inside out, this would be a tray that was scanned from above
"$HERE/../refuses" 'block.stl: no surface over 100 % of the anomaly' fettle-grind plan.json --stock block.stl --cell 0.2
# One facet beside the anomaly: nothing is ground there.
block 0
awk '/^vertex 18 18 5.3/ && !done { $0 = "vertex nan 18 5.3"; done = 1 } { print }' block.stl > other.stl && mv other.stl block.stl
[ "$(removed)" = "$whole" ] || awk -v a="$(removed)" -v b="$whole" 'BEGIN { exit (a / b - 1) ^ 2 > 1e-12 }'
grep -q '^fettle-grind: warning: block.stl: 1 facet with NaN or infinite corners left out$' message && jq -e '.dropped_facets == 1' report.json > ok

# An assembly of a plate with a bore, two cones and a B-spline ring: all faces of all parts, each within the tolerance, closed, in
# the colours of the file; STL and PLY hold the same triangles. Reference: the closed forms of the solids.
design=$SAMPLES/designs/clamp.step
fettle-step "$design" --tolerance 0.02 --report r.json -o clamp.ply
jq -e '(.faces | length) == 7 + 2 * 3 + 1 and .solids == 4 and .file_unit == "millimetre" and .open_edges == 0 and .deviation <= 0.02
    and ([.faces[].deviation] | max) == .deviation and all(.faces[]; .triangles > 0)
    and ([.faces[] | select(.part == "clamp/pin")] | length == 6 and all(.[]; .colour == [255, 0, 0]))' r.json > /dev/null
fettle-step "$design" --tolerance 0.02 -o clamp.stl
fettle-diff --tol 0 clamp.ply clamp.stl
head -c 400 clamp.ply | grep -aq '^property int face'
# points of the ring lie on the torus about (30, 20, 40): radii 20 and 4
fettle-compare clamp.ply --to clamp.stl --format csv > points.csv
awk -F, 'NR > 1 && $3 > 35 { r = sqrt(($1 - 30)^2 + ($2 - 20)^2) - 20; d = sqrt(r * r + ($3 - 40)^2) - 4; n++; if (d > 1e-4 || d < -1e-4) bad++ }
    END { exit !(n > 500 && bad == 0) }' points.csv
# in inches the tolerance and the deviation are, too
fettle-step "$design" --tolerance 0.00078740157 --units in --report inches.json -o inches.stl
jq -e --slurpfile mm r.json '.deviation <= 0.00078741 and .triangles < 1.1 * $mm[0].triangles and .triangles > 0.9 * $mm[0].triangles' inches.json > /dev/null

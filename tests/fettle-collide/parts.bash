# Parts over the bench of samples/robots/irb1400.json, each NAME.stl with a path NAME.pcd of joined strokes on its upper side; to be
# sourced by the cases.
place() { # X Y Z: moves a text STL
    awk -v x="$1" -v y="$2" -v z="$3" '$1 == "vertex" { printf "vertex %.6f %.6f %.6f\n", $2 + x, $3 + y, $4 + z; next } { print }'
}
# grid NU NV 'x(u, v); y; z' CLOSED: a text STL of z over a grid, u and v from 0 to 1, with a floor at z = 0 if closed
grid() {
    awk -v nu="$1" -v nv="$2" -v closed="${4:-0}" '
        function point(i, j, low,    u, v) { u = i / nu; v = j / nv; '"$3"'; return sprintf("vertex %.6f %.6f %.6f", x, y, low ? floor_ : z) }
        function facet(a, b, c) { print "facet normal 0 0 0\nouter loop\n" a "\n" b "\n" c "\nendloop\nendfacet" }
        BEGIN {
            print "solid s"
            for (i = 0; i < nu; ++i)
                for (j = 0; j < nv; ++j) {
                    a = point(i, j, 0); b = point(i + 1, j, 0); c = point(i + 1, j + 1, 0); d = point(i, j + 1, 0)
                    facet(a, b, c); facet(a, c, d)
                    if (closed) { a = point(i, j, 1); b = point(i + 1, j, 1); c = point(i + 1, j + 1, 1); d = point(i, j + 1, 1); facet(a, c, b); facet(a, d, c) }
                }
            for (i = 0; closed && i < nu; ++i) {
                facet(point(i, 0, 0), point(i, 0, 1), point(i + 1, 0, 1)); facet(point(i, 0, 0), point(i + 1, 0, 1), point(i + 1, 0, 0))
                facet(point(i, nv, 0), point(i + 1, nv, 1), point(i, nv, 1)); facet(point(i, nv, 0), point(i + 1, nv, 0), point(i + 1, nv, 1))
            }
            for (j = 0; closed && j < nv; ++j) {
                facet(point(0, j, 0), point(0, j + 1, 1), point(0, j, 1)); facet(point(0, j, 0), point(0, j + 1, 0), point(0, j + 1, 1))
                facet(point(nu, j, 0), point(nu, j, 1), point(nu, j + 1, 1)); facet(point(nu, j, 0), point(nu, j + 1, 1), point(nu, j + 1, 0))
            }
            print "endsolid"
        }' /dev/null
}
# rows NAME OPTION…: joined rows over the upper side of NAME.stl, whose surface is NAME-top.stl
rows() {
    local name=$1
    shift
    fettle-surfel "$name-top.stl" --stock "$name-top.stl" --spacing 2 -q |
        fettle-path --step-over 6 --spacing 2 --clearance 15 --approach 5 --part "$name.stl" "$@" -o "$name.pcd"
}
# a part of a cylinder of 25 mm radius, 80 mm long, on a block
make_cylinder() {
    local shape='x = 80 * u; y = 48 * v - 24; z = 30 + sqrt(625 - y * y) - 25; floor_ = 0'
    grid 8 96 "$shape" 1 | place 960 1000 460 >cylinder.stl
    grid 8 72 "x = 80 * u; y = 30 * v - 15; z = 30 + sqrt(625 - y * y) - 25; floor_ = 0" | place 960 1000 460 >cylinder-top.stl
    cylinder_rows
}
cylinder_rows() { rows cylinder ${1:+--orientation "$1"}; }
# a twisted, thin blade, hollow across and falling away at its tip
make_blade() {
    local shape='x = 120 * u; y = 40 * v - 20; z = 40 - 8 * u * u + 0.4 * u * (v - 0.5) * 20 - 0.006 * y * y; floor_ = z - 3'
    grid 40 20 "$shape" 1 | place 940 1000 450 >blade.stl
    grid 40 20 "u = 0.05 + 0.9 * u; v = 0.1 + 0.8 * v; $shape" | place 940 1000 450 >blade-top.stl
    rows blade
}
# a hull, keel up
make_hull() {
    local shape='x = 160 * u; y = (80 * v - 40) * (0.35 + 0.65 * sqrt(1 - (2 * u - 1) ^ 2)); z = 12 + 36 * (1 - (2 * v - 1) ^ 2) * (0.4 + 0.6 * (1 - (2 * u - 1) ^ 2)); floor_ = 0'
    grid 60 40 "$shape" 1 | place 920 1000 450 >hull.stl
    grid 40 24 "u = 0.2 + 0.6 * u; v = 0.3 + 0.4 * v; $shape" | place 920 1000 450 >hull-top.stl
    rows hull
}

# A closed mesh that is inside out is solid all the same: a ball wholly inside it, as link of the robot and as workpiece. Reference: the
# same mesh the right way round.
box() { # X0 Y0 Z0 X1 Y1 Z1 FIRST SECOND: facets, their second and third vertex in this order
    awk -v first="$7" -v second="$8" -v lo="$1 $2 $3" -v hi="$4 $5 $6" 'BEGIN {
        split(lo, l, " "); split(hi, h, " ")
        n = split("0 2 3 0 3 1 4 5 7 4 7 6 0 1 5 0 5 4 2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5", corner, " ")
        print "solid b"
        for (k = 1; k <= n; k += 3) {
            print "facet normal 0 0 0\nouter loop"
            split(corner[k] " " corner[k + first] " " corner[k + second], c, " ")
            for (i = 1; i <= 3; ++i)
                print "vertex " (int(c[i] / 4) % 2 ? h[1] : l[1]) " " (int(c[i] / 2) % 2 ? h[2] : l[2]) " " (c[i] % 2 ? h[3] : l[3])
            print "endloop\nendfacet"
        }
        print "endsolid" }'
}
robot=$SAMPLES/robots/irb1400.json
head -c 100000 "$SAMPLES/paths/keel.pcd" | awk 'data && n++ { next } /^(WIDTH|POINTS)/ { $2 = 1 } { print } $1 == "DATA" { data = 1 }' >one.pcd
read -r x y z < <(awk 'data { print $1, $2, $3 } $1 == "DATA" { data = 1 }' one.pcd)
jq '.bodies |= map(select(.name == "ball"))  | .allowed = []' "$robot" >ball.json
for order in '1 2' '2 1'; do
    # shellcheck disable=SC2086
    box "$((${x%.*} - 50))" "$((${y%.*} - 60))" "$((${z%.*} - 70))" "$((${x%.*} + 50))" "$((${y%.*} + 60))" "$((${z%.*} + 70))" $order >part.stl
    status=0
    fettle-collide ball.json one.pcd --workpiece part.stl --report part.json -q -o /dev/null || status=$?
    test $status = 1
    jq '.min.clearance' part.json
    jq --arg file part.stl '.bodies += [{name: "crate", link: -1, shape: "mesh", file: $file}]' ball.json >crate.json
    status=0
    fettle-collide crate.json one.pcd --report crate-report.json -q -o /dev/null || status=$?
    test $status = 1
    jq '.min.clearance' crate-report.json
done >depths
test "$(sort -u <(sed -n '1p;3p' depths) | wc -l)" = 1
test "$(sort -u <(sed -n '2p;4p' depths) | wc -l)" = 1

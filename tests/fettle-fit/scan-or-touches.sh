# What points are taken for is said by --as, else by whether they have roles, whatever their number: 290 and 310 of the same scan give
# the same surface. Reference: the sphere of 200 mm that they lie on, with 5 mm of anomaly inside B.
source "$HERE/points.bash"
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"}, "probe": {"accuracy": 0.1},
  "anomaly": [[-15, -15], [15, -15], [15, 15], [-15, 15]], "sampling": [[-50, -50], [50, -50], [50, 50], [-50, 50]]}' >job.json
scan() { # COUNT HEIGHT OF THE ANOMALY
    awk -v n="$1" -v h="$2" 'BEGIN { srand(4); for (i = 0; i < n; ++i) {
        x = 100 * rand() - 50; y = 100 * rand() - 50; z = sqrt(40000 - x * x - y * y) - 190
        z += 0.02 * sqrt(-2 * log(1 - rand())) * cos(6.283185 * rand())
        printf "%.6f %.6f %.6f\n", x, y, z + (x * x < 225 && y * y < 225 ? h : 0) } }'
}
echo '{"kind": "surface", "units": {"length": "mm"},
 "shape": {"type": "sphere", "point": [0, 0, 10], "normal": [0, 0, 1], "curvature": 0.005}, "touches": [[-50, -50, 0, 1]]}' |
    fettle-mesh --step 3 --within job.json >truth.pcd
fits() { # AS TOUCHES ARGUMENTS...
    fettle-fit job.json "${@:3}" --report report.json >surface.json
    jq -e --arg kind "$1" --argjson touches "$2" '.as == $kind and .touches == $touches' report.json
    fettle-mesh surface.json --at truth.pcd | fettle-diff --tol 0.1 truth.pcd -
}
counts=(290 310)
[ "${FETTLE_DRAWS:-all}" != all ] || counts+=(4000) # make test-all
for count in "${counts[@]}"; do
    outside=$(scan $count 5 | awk '$1 ^ 2 > 225 || $2 ^ 2 > 225' | wc -l)
    scan $count 5 | pcd x y z | sed 1d >scan.pcd
    for method in auto bspline sphere; do
        fits scan "$outside" scan.pcd --method $method
        jq -e --argjson inside $((count - outside)) '.inside_anomaly == $inside' report.json
    done
    # a scan's roles do not bring the anomaly back
    scan $count 5 | touches | sed 1d >roles.pcd
    fits scan "$outside" roles.pcd --as scan
    scan $count 0 | touches | sed 1d >touches.pcd
    fits touches $count touches.pcd
    scan $count 0 | pcd x y z | sed 1d >bare.pcd
    fits touches $count bare.pcd --as touches
done
# Every other point 2 mm lower, as of a second layer: nothing tells which one is the metal, so there is a warning.
scan 2000 5 | pcd x y z | sed 1d | awk '/^[-0-9]/ && NF == 3 && ++n % 2 { $3 -= 2 } { print }' >ghost.pcd
for method in auto bspline; do
    fettle-fit job.json ghost.pcd --method $method >surface.json 2>message
    [ "$(wc -l <message)" -eq 1 ]
    grep -F "ghost.pcd: the scan's points scatter by" message
done
# With normals the lower layer is an underside, and left out with the walls; so it is where all of it is there.
scan 4000 5 | awk '{ print $1, $2, $3, 0, 0, 2; print $1, $2, $3 - 20, 0, 0, -2; if (NR % 10 == 0) print $1, $2, $3 - 10, 3, 0, 0 }' |
    pcd x y z normal_x normal_y normal_z | sed 1d >closed.pcd
outside=$(scan 4000 5 | awk '$1 ^ 2 > 225 || $2 ^ 2 > 225' | wc -l)
for method in auto bspline; do
    fits scan "$outside" closed.pcd --method $method
    jq -e '.overhanging == 4400' report.json
done
awk 'NF == 6 && $1 ~ /^[-0-9]/ { $6 = -1 } { print }' closed.pcd >inward.pcd
"$HERE/../refuses" 'inward.pcd: a fit needs at least 6 touches, got 0 of 8400 points that it may use; 8400 face down or sideways' \
    fettle-fit job.json inward.pcd

# What points are taken for does not hang on their number alone: 290 and 310 of the same scan give the same surface as a scan, and
# as touches. Reference: the sphere of 200 mm that they lie on, with 5 mm of anomaly inside B.
source "$HERE/points.bash"
refuses=$HERE/../refuses
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"}, "probe": {"accuracy": 0.1},
  "anomaly": [[-15, -15], [15, -15], [15, 15], [-15, 15]], "sampling": [[-50, -50], [50, -50], [50, 50], [-50, 50]]}' >job.json
scan() { # COUNT HEIGHT OF THE ANOMALY
    awk -v n="$1" -v h="$2" 'BEGIN { srand(4); for (i = 0; i < n; ++i) {
        x = 100 * rand() - 50; y = 100 * rand() - 50; z = sqrt(40000 - x * x - y * y) - 190
        z += 0.02 * sqrt(-2 * log(1 - rand())) * cos(6.283185 * rand())
        printf "%.6f %.6f %.6f\n", x, y, z + (x * x < 225 && y * y < 225 ? h : 0) } }' | pcd x y z | sed 1d
}
echo '{"kind": "surface", "units": {"length": "mm"},
 "shape": {"type": "sphere", "point": [0, 0, 10], "normal": [0, 0, 1], "curvature": 0.005}, "touches": [[-50, -50, 0, 1]]}' |
    fettle-mesh --step 3 --within job.json >truth.pcd
for count in 290 310; do
    scan $count 5 >scan.pcd
    fettle-fit job.json scan.pcd --as scan --report report.json >surface.json
    jq -e '.as == "scan" and .inside_anomaly > 10' report.json
    fettle-mesh surface.json --at truth.pcd | fettle-diff --tol 0.1 truth.pcd -
    scan $count 0 >touches.pcd
    fettle-fit job.json touches.pcd --as touches --report report.json >surface.json
    jq -e --argjson count $count '.as == "touches" and .touches == $count' report.json
    fettle-mesh surface.json --at truth.pcd | fettle-diff --tol 0.1 truth.pcd -
done
fettle-fit job.json scan.pcd --report report.json >surface.json
jq -e '.as == "scan"' report.json
scan 1001 0 >many.pcd
"$refuses" 'many.pcd: --as touches: 1001 are more than 1000' fettle-fit job.json many.pcd --as touches
# Every other point 2 mm lower, as of a second layer: nothing tells which one is the metal, so there is a warning.
scan 2000 5 | awk '/^[-0-9]/ && NF == 3 && ++n % 2 { $3 -= 2 } { print }' >ghost.pcd
fettle-fit job.json ghost.pcd >surface.json 2>message
[ "$(wc -l <message)" -eq 1 ]
grep -F "ghost.pcd: the scan's points scatter by" message

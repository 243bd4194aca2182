# Touches that lie on a line but for less than the probe resolves determine no surface, whatever the method: the height beside the
# line would be an extrapolation of their noise. Reference: by hand.
source "$HERE/points.bash"
job freeform | jq '.probe.accuracy = 0.005' >freeform.json
job swept ', "direction_deg": 30' | jq '.probe.accuracy = 0.005' >swept.json
for job in freeform.json swept.json; do
    awk 'BEGIN { srand(2); for (i = 0; i < 20; ++i) { t = 3 * rand() - 1.5
        printf "%.7f %.7f %.7f\n", t * cos(0.5235988) - 0.002 * rand(), t * sin(0.5235988), 0.1 * t * t + 0.001 * rand() } }' |
        touches >line.pcd
    for method in auto cylinder swept quadratic griddata bspline bspline-wang; do
        "$HERE/../refuses" 'line.pcd: touches lie on one line in x and y' fettle-fit $job line.pcd --method $method
    done
done
# A surface that is not determined beneath the anomaly gets no shift.
echo '{"kind": "surface", "units": {"length": "in"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 5, "slope": [0, 0]},
  "covariance": [1e-6, 0, 1e18, 0, 0, 1e-6], "touches": [[0, 0, 5, 1]]}' >open.json
"$HERE/../refuses" 'open.json: the touches do not determine the surface beneath the anomaly: its predicted error' \
    fettle-margin freeform.json open.json

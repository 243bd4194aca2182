# Exact touches of Franke's function (1979, test 1) at his 33 points: two peaks and a dip, each as wide as the distance of a few
# touches. None is an outlier, whichever way the part lies and whatever the probe's accuracy. Reference: the formula.
source "$HERE/points.bash"
xs='.05 0 0 0 .10 .10 .15 .20 .25 .30 .35 .50 .50 .55 .60 .60 .60 .65 .70 .70 .70 .75 .75 .75 .80 .80 .85 .90 .90 .95 1 1 1'
ys='.45 .50 1 0 .15 .75 .30 .10 .20 .35 .85 0 1 .95 .25 .65 .85 .70 .20 .65 .90 .10 .35 .85 .40 .65 .25 .35 .80 .90 0 .50 1'
job='{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"}, "probe": {"accuracy": 0.127},
  "anomaly": [[40, 40], [60, 40], [60, 60], [40, 60]], "sampling": [[0, 0], [100, 0], [100, 100], [0, 100]]}'
for mirror in 0 1 2 3; do
    paste <(tr ' ' '\n' <<<"$xs") <(tr ' ' '\n' <<<"$ys") | awk -v mirror=$mirror '{
        u = mirror % 2 ? 1 - $1 : $1; v = mirror > 1 ? 1 - $2 : $2; p = 9 * u; q = 9 * v
        f = .75 * exp(-((p - 2) ^ 2 + (q - 2) ^ 2) / 4) + .75 * exp(-(p + 1) ^ 2 / 49 - (q + 1) / 10)
        f += .5 * exp(-((p - 7) ^ 2 + (q - 3) ^ 2) / 4) - .2 * exp(-(p - 4) ^ 2 - (q - 7) ^ 2)
        printf "%g %g %.6f\n", 100 * $1, 100 * $2, 100 * f }' | touches | sed 1d >touches.pcd
    for accuracy in 0.01 0.127 1; do
        jq ".probe.accuracy = $accuracy" <<<"$job" >job.json
        for method in auto bspline; do
            fettle-fit job.json touches.pcd --method $method --report report.json >surface.json 2>warnings
            jq -e '.touches == 33 and .outliers == 0' report.json || { echo "$mirror $accuracy $method"; cat warnings; false; }
        done
    done
done

# Scans of more points than the exact posterior takes. Reference: the sphere of 200 mm that they lie on; what the file
# holds, counted here.
source "$HERE/points.bash"
job freeform | jq '.units.length = "mm" | .probe.accuracy = 0.127 | (.anomaly, .sampling) |= map(map(. * 25))' >job.json
sphere='{"kind": "surface", "units": {"length": "mm"},
 "shape": {"type": "sphere", "point": [0, 0, 10], "normal": [0, 0, 1], "curvature": 0.005},
 "touches": [[-55, -55, 0, 1], [55, 55, 0, 1]]}'
echo "$sphere" >sphere.json
fettle-mesh sphere.json --step 1.7 --within job.json >truth.pcd

# 5000 scattered points with 0.02 mm of noise, 5 mm of anomaly inside B (35 x 35 mm), one in ten 1 to 10 mm off, one in
# fifty without a height. A twentieth of a millimetre at the bridge is far more than noise and bridge need.
awk 'BEGIN { srand(3); for (i = 0; i < 5000; ++i) {
    x = 110 * rand() - 55; y = 110 * rand() - 55; z = sqrt(40000 - x * x - y * y) - 190
    z += 0.02 * sqrt(-2 * log(1 - rand())) * cos(6.283185 * rand())
    if (x ^ 2 < 289 && y ^ 2 < 289) z += 5
    if (i % 10 == 3) z += 1 + 9 * rand()
    if (i % 50 == 7) z = "nan"
    printf "%.9f %.9f %s\n", x, y, z } }' >rows
pcd x y z <rows | sed 1d >scan.pcd
fettle-fit --method bspline job.json scan.pcd --report report.json -o surface.json
inside=$(awk '$3 != "nan" && $1 ^ 2 <= 306.25 && $2 ^ 2 <= 306.25' rows | wc -l)
outside=$(awk '$3 != "nan" && ($1 ^ 2 > 2500 || $2 ^ 2 > 2500)' rows | wc -l)
jq -e --argjson inside "$inside" --argjson outside "$outside" '.method == "bspline" and .undefined == 100 and
    .inside_anomaly == $inside and .outside_sampling == $outside and .touches == 4900 - $inside - $outside and
    .ignored == 5000 - .touches and (.outliers / .touches - 0.1 | fabs) < 0.01 and (.touch_sigma - 0.02 | fabs) < 0.001' report.json
fettle-mesh surface.json --at truth.pcd | fettle-diff --tol 0.05 truth.pcd -
# the standard deviation and the margin come from the precision
fettle-mesh surface.json --at truth.pcd --sigma >sigma.pcd
fettle-margin job.json surface.json --report margin.json >desired.json
jq -e '.shift > 0.01 and .shift < 0.3' margin.json
# what is written is read again
jq -e '.precision.weights | length > 12' desired.json
# with roles nothing is left out by place: the anomaly is taken for the surface
sed 's/$/ 1/' rows | pcd x y z role | sed 1d >roles.pcd
fettle-fit --method bspline job.json roles.pcd --report report.json >/dev/null
jq -e '.touches == 4900 and .undefined == 100 and .inside_anomaly == 0' report.json

# A binary file is streamed, a pipe copied; both give the same bytes for any number of threads. F4: 4e-6 mm at 55 mm.
fettle-mesh sphere.json --step 0.3 >big.pcd
fettle-fit --method bspline job.json big.pcd --threads 1 --report report.json >one.json
points=$(grep -a -m 1 '^POINTS' big.pcd | cut -d ' ' -f 2)
jq -e --argjson points "$points" '.touches + .ignored == $points and $points > 100000' report.json
fettle-fit --method bspline job.json big.pcd --threads 2 | cmp one.json
# shellcheck disable=SC2002
cat big.pcd | fettle-fit --method bspline job.json | cmp one.json
fettle-mesh one.json --at truth.pcd | fettle-diff --tol 5e-5 truth.pcd -
# refused as ever
refuses=$HERE/../refuses
head -c 1500000 big.pcd >short.pcd
"$refuses" 'short.pcd: POINTS' fettle-fit --method bspline job.json short.pcd
{ cat big.pcd big.pcd; } >twice.pcd
"$refuses" 'another PCD follows' fettle-fit --method bspline job.json twice.pcd
sed '0,/# units mm/s//# units in/' big.pcd >inch.pcd
"$refuses" 'units: the file says in, expected mm' fettle-fit job.json inch.pcd

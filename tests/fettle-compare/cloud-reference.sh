# A cloud as reference: a quadratic grid is represented exactly along z. Reference: the offsets that were added.
# 2e-6 is the rounding of float coordinates of size 10.
quadratic() { awk -v step="$1" -v lift="$2" -v reach="$3" 'BEGIN {
    for (x = -reach; x <= reach; x += step) for (y = -reach; y <= reach; y += step)
        printf "%.7g %.7g %.7g\n", x, y, 0.02 * x * x - 0.01 * x * y + 0.1 * y + lift }'; }
quadratic 0.5 0 10 >reference.xyz
quadratic 0.73 0.125 8 >test.xyz
fettle-compare test.xyz --to reference.xyz --mode z --tolerance 0.125001 --report report.json >errors.pcd
jq -e '.undefined == 0 and .min > 0.125 - 2e-6 and .max < 0.125 + 2e-6 and .reference_sigma < 2e-6' report.json >/dev/null
# A tilted plane against itself: no error but at the border, where nothing surrounds a point.
awk 'BEGIN { for (x = 0; x < 20; x++) for (y = 0; y < 20; y++) print x / 2, y / 2, x / 4 + y / 16 }' >plane.xyz
fettle-compare plane.xyz --to plane.xyz --report report.json >errors.pcd
jq -e '.undefined == 4 * 19 and .max < 2e-6 and .min > -2e-6' report.json >/dev/null

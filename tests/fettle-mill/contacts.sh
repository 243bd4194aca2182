# Contact points are no tool tips: a ball of 6 mm that touches a slope of 3:4 leaves its plane there, and contacts of a
# ball, a bull-nose and a tapered cutter, 0.05 mm apart, all leave the same slope. Reference: the plane, from which a row
# of contacts can leave no more than the scallop.
awk 'BEGIN { print "x y z normal_x normal_y normal_z"
    for (i = 0; i <= 300; i++) for (j = 0; j <= 1; j++) {
        x = 5 + 0.05 * i; y = (i + j) % 2 ? 5 : 15; printf "%.9g %.9g %.9g -0.6 0 0.8\n", x, y, 0.75 * x } }' > contacts.xyz
for cutter in ball:6 bull:6,1 taper:6,30,1 flat:6; do
    fettle-mill contacts.xyz --points cc --stock box:8,8,-9,18,12,19 --cutter $cutter --step 0.1 --pcd --ascii > cut.pcd
    awk -v cutter=$cutter '/^DATA/ { body = 1; next }
        body { e = $3 - 0.75 * $1; if (e < min) min = e; if (e > max) max = e; n++ }
        END { if (min < -1e-5 || max > (cutter ~ /flat/ ? 0.0376 : 7e-4) || n != 4000) { print cutter, min, max; exit 1 } }' cut.pcd
done

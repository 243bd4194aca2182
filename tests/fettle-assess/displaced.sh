# Stock that rises by 0.2 along x and 0.3 along y over a plate: its surface and the normals there, exactly; and a warning where
# stock of 1.2 mm lies over a radius of 10 mm. Reference: the plane, and |D| / R.
cat > plate.json <<'JSON'
{"kind": "patches", "units": {"length": "mm"}, "patches": [{"degree": [1, 1], "knots_u": [0, 0, 10, 10], "knots_v": [0, 0, 6, 6],
  "control": [[[0, 0, 0], [0, 6, 0]], [[10, 0, 0], [10, 6, 0]]]}]}
JSON
printf 'OFF\n4 1 0\n-1 -1 -0.5\n11 -1 1.9\n11 7 4.3\n-1 7 1.9\n4 0 1 2 3\n' > slope.off
fettle-surfel plate.json --stock slope.off --spacing 0.5 > work.pcd
fettle-assess work.pcd --lower -1 --upper 5 --displaced --ascii --report report.json |
    awk '/^[-0-9]/ && NF > 11 { ++n; if (($3 - 0.2 * $1 - 0.3 * $2) ^ 2 > 1e-10 || ($4 / $6 + 0.2) ^ 2 > 1e-10 || ($5 / $6 + 0.3) ^ 2 > 1e-10) bad = 1 }
         END { exit bad || n < 240 }'
jq -e '.beyond == 0 and .undetermined == 0 and .largest_bend < 1e-6' report.json > ok
awk -v R=10 'BEGIN { print "OFF\n400 199 0"; for (i = 0; i < 200; ++i) { a = i / 199 * 3.14159265358979 / 2; for (y = 0; y <= 20; y += 20) print R * sin(a), y, R * cos(a) }
             for (i = 0; i < 199; ++i) print 4, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1 }' > design.off
awk '{ if (NF == 3 && NR > 2) { $1 *= 1.12; $3 *= 1.12 } print }' design.off > stock.off
fettle-surfel design.off --stock stock.off --spacing 0.5 -q > tube.pcd
fettle-assess tube.pcd --lower 0 --upper 5 --displaced --report bend.json 2> warning > displaced.pcd || true
grep -q '|displacement| times curvature exceeds 0.1' warning
jq -e '(.largest_bend - 0.12 | fabs) < 0.006 and .beyond > 1000' bend.json > ok

# Lines through a bicubic surface are cubics, so the estimated points lie on it: z = x y (x - 3)(y - 2)/10 + x³ - y³ in
# inches. Reference: the formula; 3e-4 is the rounding of float coordinates, magnified by the extrapolating cubic.
cat > job.json <<'JOB'
{"kind": "job", "units": {"length": "in"}, "surface": {"type": "freeform"},
 "anomaly": [[1, 1], [2, 1], [2, 2], [1, 2]], "sampling": [[0, 0], [3, 0], [3, 3], [0, 3]]}
JOB
formula='function f(x, y) { return x * y * (x - 3) * (y - 2) / 10 + x^3 - y^3 }'
fettle-sample job.json --plan-only --ascii |
    awk "$formula"' /^[0-9]/ && !/^[0-9.]* [0-9]$/ && NF == 5 { $3 = f($1, $2) } { print }' > samples.pcd
fettle-estimate job.json samples.pcd --ascii --report report.json > points.pcd
grep -A 99 '^DATA' points.pcd | tail -n 4 | awk '{ printf "%.4f %.4f %s %s\n", $1, $2, $4, $5 }'
grep -A 99 '^DATA' points.pcd | tail -n 4 | awk "$formula"'{ d = $3 - f($1, $2); if (d > 3e-4 || d < -3e-4) exit 1 }'
awk "$formula"' body && $5 == 3 { $3 = f($1, $2) } /^DATA/ { body = 1 } { print }' points.pcd | fettle-diff points.pcd - --tol 3e-4 > ok
jq -c '[.touches, .estimated]' report.json
# binary from a pipe is the same
fettle-estimate job.json --ascii < samples.pcd | cmp points.pcd -

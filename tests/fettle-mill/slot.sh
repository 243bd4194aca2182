# A ball of 6 mm along a sloped line. Reference: the closed form, the lower side of a cylinder about the line (its ends
# are left out); heights are floats, 1e-6 of their size.
printf 'x y z\n5 10 6\n35 10 12\n' > path.xyz
fettle-mill path.xyz --stock box:0,0,0,40,20,20 --cutter ball:6 --step 0.1 --pcd --ascii --report report.json > cut.pcd
awk 'BEGIN { m = 0.2; c = sqrt(1 + m * m) }
    /^DATA/ { body = 1; next }
    body && $1 > 8 && $1 < 32 && ($2 - 10) ^ 2 < 9 { z = 6 + m * ($1 - 5) + 3 - c * sqrt(9 - ($2 - 10) ^ 2)
        if ($3 - z > 5e-6 || z - $3 > 5e-6) { print; bad++ }; n++ }
    END { exit bad > 0 || n != 240 * 60 }' cut.pcd
jq -e '(.time * 10 / .feed_length - 1 | fabs) < 1e-12 and (.feed_length - (936 | sqrt) | fabs) < 1e-12 and .moves == 1 and
       .columns == 400 and .rows == 200' report.json > ok

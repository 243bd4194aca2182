# Bumps with steep walls and much noise: a step of 0.5 mm and a cone of 3.5 mm over it, along the normal of a wavy sheet of 22,500 points (the
# construction of pointSGRADE's simulated set: Tao, Du, Chang). Points at the foot of a wall share cells with points on it.
# Reference: the bumps' own points; DICE, twice the points in common over the points of both.
awk 'function gauss(   k, g) { g = 0; for (k = 0; k < 12; ++k) g += rand(); return g - 6 }
    BEGIN { srand(5); split("-12 -10 -11 8 0 0 10 -12 12 9", c); print "x y z truth"
        for (i = 0; i < 150; ++i) for (j = 0; j < 150; ++j) {
            x = (i - 75) * 4 / 15; y = (j - 75) * 4 / 15; z = 1.2 * sin(x / 6) * cos(y / 7)
            nx = -0.2 * cos(x / 6) * cos(y / 7); ny = 1.2 / 7 * sin(x / 6) * sin(y / 7); n = sqrt(nx * nx + ny * ny + 1)
            d = 9; for (k = 1; k <= 9; k += 2) { r = sqrt((x - c[k]) ^ 2 + (y - c[k + 1]) ^ 2); if (r < d) d = r }
            h = d <= 1.75 ? 3.5 * (1 - d / 1.75) + 0.5 : 0
            printf "%.5f %.5f %.5f %d\n", x + h * nx / n + 0.025 * gauss(), y + h * ny / n + 0.025 * gauss(), z + h / n + 0.12 * gauss(), (h > 0)
        } }' > bumps.xyz
fettle-find bumps.xyz --ascii --report bumps.json -o found.pcd || [ $? = 1 ]
jq -e '.anomalies | length == 5 and all(.probability > 0.9)' bumps.json > ok
sed '1,/^DATA/d' found.pcd | awk '{ both += $4 && $5; sum += ($4 > 0) + ($5 > 0) } END { print 2 * both / sum; exit !(2 * both / sum >= 0.99) }'

# A cloud: a ball's cap of 1.2 mm on a curved sheet with 0.03 mm of noise, in any unit, for any number of threads; none on the bare sheet.
# Reference: the cap's own points, and its height, area and volume.
sheet() { # CAP SEED
    awk -v cap="$1" -v seed="$2" 'BEGIN { srand(seed)
        for (y = 0; y < 100; ++y) for (x = 0; x < 120; ++x) {
            g = 0; for (k = 0; k < 12; ++k) g += rand()
            d = sqrt((x - 70) ^ 2 + (y - 45) ^ 2) / 12
            h = cap * (d < 1 ? 1 - d * d : 0)
            printf "%g %g %.4f %d\n", x / 2, y / 2, h + x * x / 4000 + 0.03 * (g - 6), (h > 0.05) } }'
}
{ echo 'x y z truth'; sheet 1.2 3; } > worn.xyz
sheet 0 4 > bare.xyz
fettle-find bare.xyz --report bare.json > bare.pcd
jq -e '.anomalies == [] and .noise > 0.02 and .noise < 0.04' bare.json > ok
for threads in 1 2 5; do
    fettle-find worn.xyz --ascii --threads $threads --report $threads.json -o $threads.pcd || [ $? = 1 ]
done
cmp 1.pcd 2.pcd && cmp 1.pcd 5.pcd
jq -e '(.anomalies | length) == 1 and (.anomalies[0] | .probability > 0.5 and .height > 1 and .height < 1.4)' 1.json > ok
# A cap of radius R and height H: area pi R², volume pi R² H / 2.
jq -e '.anomalies[0] | (.area - 113) / 113 | fabs < 0.15' 1.json > ok
jq -e '.anomalies[0] | (.volume - 67.9) / 67.9 | fabs < 0.15' 1.json > ok
sed '1,/^DATA/d' 1.pcd | awk '{ both += $4 && $5; either += $4 || $5 } END { exit !(both / either > 0.85) }'
awk 'NR > 1 { print $1 / 25.4, $2 / 25.4, $3 / 25.4 }' worn.xyz > inch.xyz
fettle-find inch.xyz --file-units in --report inch.json > inch.pcd || [ $? = 1 ]
jq -e --slurpfile mm 1.json '(.anomalies | length) == 1 and .units.length == "in" and
    (.anomalies[0].height * 25.4 - $mm[0].anomalies[0].height | fabs < 0.02)' inch.json > ok

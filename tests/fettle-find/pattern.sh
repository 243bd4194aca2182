# Five pins of one height and a mound on a plate: the pins are a pattern by design, the mound is an anomaly. Pins of five heights are no pattern, but by
# their flat tops more probably by design; cones of one height are anomalies. Reference: what was put there.
plate() { # HEIGHT-STEP: of each pin over the one before, mm; SHARE: of their height that they fall from the middle to the edge; SEED
    awk -v step="$1" -v fall="$2" -v seed="$3" 'function gauss(   k, g) { g = 0; for (k = 0; k < 12; ++k) g += rand(); return g - 6 }
        BEGIN { srand(seed); print "x y z"
            split("15 15 75 15 75 75 15 75 45 20", pin)
            for (i = 0; i <= 150; ++i) for (j = 0; j <= 150; ++j) {
                x = 0.6 * i; y = 0.6 * j; z = 0
                for (k = 1; k <= 5; ++k) if ((r = (x - pin[2 * k - 1]) ^ 2 + (y - pin[2 * k]) ^ 2) < 9) z = (3 + step * k) * (1 - fall * sqrt(r) / 3)
                r = ((x - 45) ^ 2 + (y - 52) ^ 2) / 36
                if (r < 1) z = 3 * (1 - r)
                printf "%.5f %.5f %.5f\n", x, y, z + 0.03 * gauss()
            } }'
}
is_pattern='.doubt | test("as in a pattern by design")'
plate 0 0 3 > alike.xyz
fettle-find alike.xyz --report alike.json -o alike.pcd || [ $? = 1 ]
jq -e '.anomalies | length == 1 and all(.area > 90)' alike.json > ok
fettle-find alike.xyz --probability 0 --report all.json -o all.pcd || [ $? = 1 ]
jq -e "[.anomalies[] | select($is_pattern)] | length >= 5" all.json > ok
plate 0.3 0 3 > unlike.xyz
fettle-find unlike.xyz --report unlike.json -o unlike.pcd || [ $? = 1 ]
jq -e '.anomalies | length == 1 and all(.area > 90)' unlike.json > ok
fettle-find unlike.xyz --probability 0 --report unlike-all.json -o unlike.pcd || [ $? = 1 ]
jq -e "[.anomalies[] | select($is_pattern)] | length == 0" unlike-all.json > ok
plate 0 0.8 3 > cones.xyz
fettle-find cones.xyz --report cones.json -o cones.pcd || [ $? = 1 ]
jq -e '.anomalies | length == 6' cones.json > ok
# Pins that an operator keeps are found again on the next casting, although nothing but that speaks for them.
keep=$(jq -r "[.anomalies[] | select($is_pattern) | .anomaly] | join(\",\")" all.json)
fettle-find alike.xyz --probability 0 --keep "$keep" --jobs jobs --template "$SAMPLES/jobs/hammer.json" --report kept.json -o kept.pcd || [ $? = 1 ]
count=$(jq '[.anomalies[] | select(.job != "")] | length' kept.json)
[ "$count" -ge 6 ]
plate 0 0 4 > next.xyz
fettle-find next.xyz --like jobs --report next.json -o next.pcd || [ $? = 1 ]
jq -e --argjson count "$count" '.absent == null and ([.anomalies[] | select(.like != null)] | length == $count)' next.json > ok
# Digits: strokes two cells wide, of one height, are a pattern, too.
awk 'function gauss(   k, g) { g = 0; for (k = 0; k < 12; ++k) g += rand(); return g - 6 }
    function on(x, y) { return x >= 0 && x <= 6 && y >= 0 && y <= 10 && (x < 1.2 || x > 4.8 || y < 1.2 || y > 8.8) }
    function seven(x, y) { return x >= 0 && x <= 6 && y >= 0 && y <= 10 && (x > 4.8 || y > 8.8) }
    BEGIN { srand(5); print "x y z"
        for (i = 0; i <= 150; ++i) for (j = 0; j <= 150; ++j) {
            x = 0.6 * i; y = 0.6 * j
            z = 1.2 * (on(x - 15, y - 20) || seven(x - 40, y - 20) || on(x - 65, y - 20) || seven(x - 30, y - 60))
            printf "%.5f %.5f %.5f\n", x, y, z + 0.03 * gauss()
        } }' > digits.xyz
fettle-find digits.xyz --report digits.json -o digits.pcd || [ $? = 1 ]
jq -e '.anomalies | length == 0' digits.json > ok

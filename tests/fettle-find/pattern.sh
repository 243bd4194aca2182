# Five pins of one height and a mound on a plate: the pins are a pattern by design, the mound is an anomaly. Pins of five heights are no pattern.
# Reference: what was put there.
plate() { # HEIGHT-STEP: of each pin over the one before, mm
    awk -v step="$1" 'function gauss(   k, g) { g = 0; for (k = 0; k < 12; ++k) g += rand(); return g - 6 }
        BEGIN { srand(3); print "x y z"
            split("15 15 75 15 75 75 15 75 45 20", pin)
            for (i = 0; i <= 150; ++i) for (j = 0; j <= 150; ++j) {
                x = 0.6 * i; y = 0.6 * j; z = 0
                for (k = 1; k <= 5; ++k) if ((x - pin[2 * k - 1]) ^ 2 + (y - pin[2 * k]) ^ 2 < 9) z = 3 + step * k
                r = ((x - 45) ^ 2 + (y - 52) ^ 2) / 36
                if (r < 1) z = 3 * (1 - r)
                printf "%.5f %.5f %.5f\n", x, y, z + 0.03 * gauss()
            } }'
}
plate 0 > alike.xyz
fettle-find alike.xyz --report alike.json -o alike.pcd || [ $? = 1 ]
jq -e '.anomalies | length == 1 and all(.area > 90)' alike.json > ok
fettle-find alike.xyz --probability 0 --report all.json -o all.pcd || [ $? = 1 ]
jq -e '[.anomalies[] | select(.doubt | test("as in a pattern by design"))] | length >= 5' all.json > ok
plate 0.3 > unlike.xyz
fettle-find unlike.xyz --report unlike.json -o unlike.pcd || [ $? = 1 ]
jq -e '.anomalies | length == 6' unlike.json > ok

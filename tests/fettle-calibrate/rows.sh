# Exponents of a belt's law from rows drawn from it: force 2, speed 1.5, time 1.3, each found within twice its standard deviation, which is
# at most .05. The wheel that is written removes what the law says: 10 mm² in contact, 60 mm of belt in a revolution.
# Reference: the law that the rows were drawn from.
draw() { # ROWS SHARPNESS of the last row
    awk -v n="$1" -v last="$2" 'BEGIN {
        print "grind_time_s,avg_rpm,avg_force_N,initial_wear,removed_mm3"
        for (k = 0; k < n; ++k) {
            t = 5 + 3 * (k % 5); s = 7000 + 700 * (k % 4); f = 3 + k % 7; w = 1e6 * k
            printf "%.15g,%.15g,%.15g,%.15g,%.15g\n", t, s, f, w, (k == n - 1 ? last : 1) * 1e-8 * t ^ 1.3 * s ^ 1.5 * f ^ 2 * (1 + 0.02 * sin(3 * k * k))
        } }'
}
draw 40 1 > drawn.csv
fettle-calibrate drawn.csv --report law.json > learnt.json
jq -e '[.parameters[] | select(.name == "force" or .name == "speed" or .name == "duration") | .determined] == ["measured", "measured", "measured"]' law.json > ok
jq -e '.parameters | [.[] | {(.name): [.mean, .sigma]}] | add | [[.force, 2], [.speed, 1.5], [.duration, 1.3]] |
    all((.[0][0] - .[1] | fabs) <= 2 * .[0][1] and .[0][1] < 0.05)' law.json > ok
jq -e '.changes == [] and .judged == 35 and .covered >= 32 and .median_error < 0.03 and .indistinct == []' law.json > ok
fettle-calibrate drawn.csv --wheel "$SAMPLES/wheels/rubber.json" --area 10 --travel 60 > wheel.json
# 4 N for 8 s at 7700 a minute; a mean pressure of .4 MPa on 10 mm²
jq -e '.law | .coefficient * pow(0.4; .pressure_exponent) * pow(7700; .speed_exponent) * pow(8; .dwell_exponent) * 10 /
    (1e-8 * pow(8; 1.3) * pow(7700; 1.5) * 16) - 1 | fabs < 0.02' wheel.json > ok
fettle-part "$SAMPLES/parts/keel.json" -o keel.stl
fettle-surfel keel.stl --stock keel.stl --spacing 2 -o keel.pcd
fettle-belt keel.pcd --path "$SAMPLES/paths/keel.pcd" --wheel wheel.json --force 20 --report belt.json > ground.pcd
jq -e '.removed_volume > 0' belt.json > ok

# The last pass half as sharp is told, by itself and after what was known before; what is learned on is the same as all at once.
draw 40 0.5 > blunt.csv
fettle-calibrate blunt.csv --report blunt.json 2> warning > learnt-blunt.json
grep -q 'pass 40 took .*blunt' warning
jq -e '.changes | length == 1 and .[0].pass == 40' blunt.json > ok
head -n 31 blunt.csv > first.csv
(head -n 1 blunt.csv; tail -n 10 blunt.csv) > rest.csv
fettle-calibrate first.csv -o first.json
fettle-calibrate rest.csv --known first.json -q | fettle-diff - learnt-blunt.json
# The published rows, next pass from row 6 on. Reference: what was measured.
fettle-calibrate "$SAMPLES/removal/static.csv" --report static.json > static.law
jq -e '.judged == 19 and .covered >= 18 and .median_error <= 0.10' static.json > ok
fettle-calibrate "$SAMPLES/removal/moving.csv" --report moving.json > moving.law
jq -e '.judged == 6 and .covered == 6 and .median_error <= 0.08' moving.json > ok

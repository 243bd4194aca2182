# A belt that is .7 times as fast as its wheel's file says. Without learning it takes .77 of the depth that the path was made for (where less is
# taken the wheel rests on less, with more pressure); with it the feeds are
# changed from the second pass on, so that it takes that depth, and each pass is predicted to 1 % from the third on. The next part begins with what is known, and
# when its belt is half as sharp, its first pass says so. A run that is killed goes on from its journal and ends with the same bytes.
# References: what a belt as in the wheel's file takes; the law that grinds.
awk 'BEGIN { n = 41
    printf "VERSION 0.7\nFIELDS x y z normal_x normal_y normal_z displacement\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n"
    printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n * n, n * n
    for (i = 0; i < n; i++) for (j = 0; j < n; j++) { x = .75 * (i - 20); y = .75 * (j - 20); print x, y, 5, 0, 0, 1, 0.2 + 0.1 * sin(x / 4) * cos(y / 5) } }' > plate.pcd
awk 'BEGIN { n = 10 * 10
    printf "VERSION 0.7\nFIELDS x y z qw qx qy qz pass\nSIZE 4 4 4 4 4 4 4 4\nTYPE F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1\n"
    printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n, n
    for (j = 0; j < 10; j++) for (i = 0; i < 10; i++) print 2 * i - 9, 2 * j - 9, 5, 1, 0, 0, 0, j }' > rows.pcd
wheel=$SAMPLES/wheels/crowned.json
jq '.law.coefficient *= 0.7' "$wheel" > slow-wheel.json
jq '.law.coefficient *= 0.35' "$wheel" > blunt-wheel.json
grind() { # NAME OPTION…
    fettle-belt plate.pcd --path rows.pcd --wheel "$wheel" --force 10 --feed 4 --report "$1.json" -q --ascii -o "$1.pcd" "${@:2}"
}
grind wanted
grind alone --actual slow-wheel.json
grind first --actual slow-wheel.json --learn law.json --trace trace.pcd
# Depth over that which was wanted, mean and standard deviation, under the passes from the third on.
depth() {
    awk 'FNR == 1 { ++file } /^DATA/ { body[file] = 1; next } !body[file] || $2 < -4 || $2 > 9 || $1 < -8 || $1 > 8 { next }
        file == 1 { wanted[$1, $2] = $8; next } { r = $8 / wanted[$1, $2]; sum += r; squares += r * r; ++n }
        END { m = sum / n; printf "{\"mean\": %.4f, \"sd\": %.4f}\n", m, sqrt(squares / n - m * m) }' wanted.pcd "$1.pcd"
}
depth alone | jq -e '.mean > 0.7 and .mean < 0.8' > ok
depth first | jq -e '(.mean - 1 | fabs) < 0.03 and .sd < 0.03' > ok
jq -e '.learnt | .known == 0 and .passes == 10 and .changes == 0 and .covered == .judged and .median_error < 0.01 and
    all(.predictions[2:][]; (.volume / .expected - 1 | fabs) < 0.02 and .lower < .volume and .volume < .upper)' first.json > ok
jq -e --slurpfile wheel "$wheel" '(.law.coefficient / $wheel[0].law.coefficient / 0.7 - 1 | fabs) < 0.02 and .learnt.passes == 10' law.json > ok
# The trace has the feeds as they were: what fettle-calibrate learns from it, after the fact, is the same.
fettle-calibrate trace.pcd --before plate.pcd --after first.pcd --wheel "$wheel" -q |
    jq -e --slurpfile law law.json '.learnt.parameters[0].mean - $law[0].learnt.parameters[0].mean | fabs < 0.05' > ok
# The next part; killed between two passes, with the law as it was before.
cp law.json known.json
grind second --actual slow-wheel.json --learn law.json
jq -e '.learnt | .known == 10 and .judged == 10 and .changes == 0' second.json > ok
cp known.json law2.json
(grind killed --actual slow-wheel.json --learn law2.json --journal run.journal --journal-every 0) & pid=$!
while [ ! -e run.journal ] && kill -0 $pid; do sleep 0.01; done
kill -9 $pid 2>/dev/null || true
wait $pid 2>/dev/null || true
cp known.json law2.json
grind killed --actual slow-wheel.json --learn law2.json --journal run.journal --journal-every 0
for end in .pcd .json; do cmp second$end killed$end; done
cmp law.json law2.json
"$HERE/../refuses" 'run.journal: this is the journal of another run' fettle-belt plate.pcd --path rows.pcd --wheel "$wheel" --actual slow-wheel.json --force 10 \
    --feed 4 --learn law.json --journal run.journal
fettle-belt plate.pcd --path rows.pcd --wheel "$wheel" --force 10 --feed 4 --actual blunt-wheel.json --learn law.json --report blunt.json 2> warning > blunt.pcd
grep -q 'rows.pcd: pass 1 took .*the wheel is blunt or loaded' warning
jq -e '.learnt.predictions | .[0].change and (map(select(.change)) | length) < 3' blunt.json > ok
fettle-calibrate "$SAMPLES/removal/static.csv" -q -o rows.json
refused() { "$HERE/../refuses" "$1" fettle-belt plate.pcd --path rows.pcd --wheel "$wheel" --force 10 --learn "$2" -o x.pcd; }
refused 'rows.json: is no law of a belt that moves along paths' rows.json
refused 'missing/law.json: cannot write' missing/law.json
[ ! -e x.pcd ]
# A wheel with grooves and Preston's law is handed on as it is but for what its law has learnt.
jq '.serration = {pitch: 10, land: 5, depth: 3, angle_deg: 30} | .law |= {type: "preston", coefficient}' "$wheel" > grooved.json
awk '/^WIDTH|^POINTS/ { $2 = 20 } { print } /^DATA/ { n = NR } n && NR == n + 20 { exit }' rows.pcd > two-rows.pcd
fettle-belt plate.pcd --path two-rows.pcd --wheel grooved.json --force 10 --cells 16 --learn grooved-law.json --journal grooved.journal -q -o x.pcd
jq -e --slurpfile given grooved.json '.radius == $given[0].radius and .law.source == "fettle-belt --learn" and
    ([.serration | .pitch - 10, .land - 5, .depth - 3, .angle_deg - 30] | map(fabs) | max < 1e-9)' grooved-law.json > ok

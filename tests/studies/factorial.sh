# The factorial experiment on every 12th cell of the smallest, a middle and the largest radius: its programs, its make file.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v factorial)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
study() { make --no-print-directory -C "$root" -f pipelines/factorial.mk B="$build" EVERY=12 RADII='25 125 225' FACTORIAL="$PWD/all" "$@"; }
study -s "$PWD/all/factorial.json" "$PWD/all/factorial.csv" "$PWD/all/figure-4-14-saddle.png"
jq -e '.cells | length == 4 * 3 * 11' all/factorial.json
test "$(wc -l <all/factorial.csv)" -eq $((4 * 3 * 11 + 1))
test "$(head -c 4 all/figure-4-14-saddle.png | tail -c 3)" = PNG

# With the touched corners of the sampling boundary griddata covers all of each anomaly.
jq -e 'all(.cells[]; .surface == "cylinder" or .errors.griddata[2] == 1)' all/factorial.json
factorial sphere-concave 25 --every 24 --method griddata | jq -e --slurpfile all all/sphere-concave/25.json '
    all(.cells[]; . as $cell | (.errors | keys == ["griddata"]) and any($all[0].cells[]; .cell == $cell.cell and .errors.griddata == $cell.errors.griddata))'

# A cell is the same in every batch. Reference: itself, every 24th.
factorial saddle 125 --every 24 >fewer.json
jq -e --slurpfile all all/saddle/125.json '
    all(.cells[]; . as $cell | any($all[0].cells[]; . == $cell)) and (.cells | length) == 6' fewer.json

# A large sphere of 25 in, touched over 30 in, has the curvature 1/25: the touches are wrong by a 25,000th of their span.
factorial sphere-convex 25 --every 124 | jq -e '.cells[-1] | .width == 10 and .distance == 10 and (.terms[0] * 25 - 1 | fabs < 1e-3)'

# The limit is what the true family's fit scatters about. Reference: that fit, method sphere; 66 draws of one band each,
# which varies by a third of itself: their mean is within 3 / 3 / sqrt(66) of it.
jq -e '[.cells[] | select(.surface | startswith("sphere")) | .errors.sphere[0] / .limit] | add / length | . > 0.88 and . < 1.17' all/factorial.json

# Regressions are fitted as they should be. Reference: bands and shifts that are the published regression of the terms.
jq -c '.cells |= map(select(.surface == "saddle") | .terms as $x |
    def predicted(c): [c, $x] | transpose | map(.[0] * .[1]) | add;
    .errors.griddata = [predicted([.7953, .1635, .0515, .0087, -.0417, -.0066, -.0689]),
                        predicted([.2410, .1289, .0109, .0040, -.0136, -.0047, -.0266]), 1])' all/factorial.json >exact.json
factorial-table exact.json >exact.txt || test $? -eq 1
grep -A 1 '^published .* 0.7953' exact.txt | tail -n 1 |
    grep -E '^griddata +0.7953 +0.1635 +0.0515 +0.0087 +-0.0417 +-0.0066 +-0.0689 +1.00 +0.0 '
grep -A 1 '^published .* 0.2410' exact.txt | tail -n 1 |
    grep -E '^griddata +0.2410 +0.1289 +0.0109 +0.0040 +-0.0136 +-0.0047 +-0.0266 +1.00 +0.0 '

# The verdict: 0 when the default fit is at the limit, 1 when a single cell is 7 times as wide.
jq -c '.cells |= map(.errors.auto = [.limit, .limit / 2, 1])' all/factorial.json >limit.json
factorial-table limit.json >limit.txt
jq -c '.cells[17].errors.auto[0] *= 7' limit.json >worse.json
status=0
factorial-table worse.json >worse.txt || status=$?
test $status -eq 1
test "$(grep -c MISSED worse.txt)" -eq 1
grep 'worst .*MISSED' worse.txt

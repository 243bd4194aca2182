# A belt's law from the trace of one run and the surfels before and after, which are .00025 mm (5 %) off: pressure exponent 1.6, feed exponent .2
# and the coefficient are found from a guess of Preston's law, within three standard deviations, which are at most .05.
# References: the law that ground them; without noise the same to 1e-3.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate > plate.pcd
wheel 10 0.45 | jq '.law.coefficient = 3e-8' > guess.json
jq '.law = {type: "power", coefficient: 1e-6, pressure_exponent: 1.6, speed_exponent: 1, feed_exponent: 0.2}' guess.json > hidden.json
awk 'BEGIN {
    n = 4 * 11
    printf "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz pass force feed\nSIZE 4 4 4 4 4 4 4 4 4 4\nTYPE F F F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1 1 1\n"
    printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n, n
    for (j = 0; j < 4; ++j) for (i = 0; i < 11; ++i) printf "%g %g 5.25 1 0 0 0 %d %g %g\n", 2 * i - 10, 6 * j - 9, j, 6 + 6 * (j % 2), 4 + 4 * (j > 1) }' > path.pcd
fettle-belt plate.pcd --wheel hidden.json --path path.pcd --trace trace.pcd --ascii -q > ground.pcd
awk '{ if (body) $7 += 0.00025 * sqrt(-2 * log(1 - rand())) * cos(6.2831853 * rand()); print } /^DATA/ { body = 1 }' ground.pcd > noisy.pcd
calibrate() { fettle-calibrate trace.pcd --before plate.pcd --after "$1" --wheel guess.json -q "${@:2}"; }
calibrate ground.pcd > exact.json
jq -e '.law | (.pressure_exponent - 1.6 | fabs) < 1e-3 and (.feed_exponent - 0.2 | fabs) < 1e-3 and (.coefficient / 1e-6 - 1 | fabs) < 1e-3' exact.json > ok
# The forces count, not the depths for which a path was planned.
awk '/^FIELDS/ { $0 = $0 " depth" } /^SIZE/ { $0 = $0 " 4" } /^TYPE/ { $0 = $0 " F" } /^COUNT/ { $0 = $0 " 1" } body { $0 = $0 " 0.9" } /^DATA/ { body = 1 } { print }' trace.pcd > deep.pcd
fettle-calibrate deep.pcd --before plate.pcd --after ground.pcd --wheel guess.json -q | cmp - exact.json
calibrate noisy.pcd --report noisy-report.json > noisy.json
jq -e '[.belt.parameters[1:][] | [.mean, .sigma]] | (.[0][0] - 1.6 | fabs) < 3 * .[0][1] and (.[1][0] - 0.2 | fabs) < 3 * .[1][1] and
    all(.[1] > 0 and .[1] < 0.05)' noisy-report.json > ok
jq -e '.belt.depth_error / 0.00025 - 1 | fabs < 0.1' noisy-report.json > ok
# The wheel grinds, and its law can be learned on.
fettle-belt plate.pcd --wheel noisy.json --path path.pcd -q --report again.json > again.pcd
fettle-belt plate.pcd --wheel hidden.json --path path.pcd -q --report first.json > first.pcd
jq -e --slurpfile first first.json '.removed_volume / $first[0].removed_volume - 1 | fabs < 0.02' again.json > ok
calibrate noisy.pcd --known noisy.json | jq -e '.learnt.passes == 8' > ok
"$HERE/../refuses" 'the surfels before and after are not the same: 6561 and 2' fettle-calibrate trace.pcd --before plate.pcd --wheel guess.json \
    --after <(sed 's/^\(WIDTH\|POINTS\) .*/\1 2/' plate.pcd | head -n 13)

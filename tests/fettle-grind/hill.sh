# A hill of 4 mm, layers 0.5 mm apart: ground to the plane z = 5 within the tolerance of 0.1, and not below it by more than
# the 0.005 to which a touch-off measures the radius. References:
# the plane; the removed volume is the sum of what every cell lost; each number of the report is that of the trace.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
fettle-grind plan.json --stock stock.stl --cell 0.1 --trace trace.pcd --report report.json --ascii > ground.pcd
awk '/^DATA/ { body = 1; next }
     body && $1 > -6 && $1 < 6 && $2 > -6 && $2 < 6 { if ($3 > 5.1 || $3 < 5 - 0.005) bad++; n++ }
     body { volume += $4 * 0.1 * 0.1 }
     END { print volume; exit bad > 0 || n != 120 * 120 }' ground.pcd > volume
jq -e --argjson v "$(cat volume)" '(.removed_volume / $v - 1 | fabs) < 1e-5 and .finished and .layers >= 3' report.json > ok
# event: 2 up, 6 re-cut, 7 covering done, 10 touch-off; the last is 8, finished; a layer changes by one at a time.
awk '/^DATA/ { body = 1; next }
     body { n[$7]++; last = $7; if (NR > 13 && ($5 - layer) ^ 2 > 1) exit 1; layer = $5; if ($8 > peak) peak = $8 }
     END { printf "{\"raises\": %d, \"re_cuts\": %d, \"coverings\": %d, \"touch_offs\": %d, \"last\": %d}\n",
           n[2], n[6], n[7] + 1, n[10], last }' trace.pcd > counted.json
jq -e --slurpfile c counted.json '$c[0] as $c | .raises == $c.raises and .re_cuts == $c.re_cuts and
    .coverings == $c.coverings and .touch_offs == $c.touch_offs and $c.last == 8 and $c.raises == 3 and
    (.machine_time - .grinding_time - .travel_time - .service_time | fabs) < 1e-6' report.json > ok

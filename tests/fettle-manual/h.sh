# Back and forth over the raw H of Wang's part 1 at 1 in/s, up its walls and down: the force stays within a tenth of the 10 lbf to be held
# for at least 95 % of the time of contact, and metal is removed. References: the set force; the force's loop, whose margins are reported
# by fettle-grind.
fettle-part "$SAMPLES/parts/wang1.json" > part.stl
fettle-manual "$SAMPLES/jobs/wang1.json" --stock part.stl --machine "$SAMPLES/machines/full_scale.json" --steer "$SAMPLES/steering/h.txt" \
    --trace trace.pcd --report report.json --ascii > ground.pcd
jq -e '.within >= 0.95 and .contact_time > 20 and .removed_volume > 0.1 and .peak_force < 15' report.json > ok
# The report says what the trace does: rows of 5 ms with more than a twentieth of the force.
awk '/^DATA/ { body = 1; next } body && $9 > 0 && $8 > 0.5 { n++; if ($8 >= 9 && $8 <= 11) good++ }
    END { printf "{\"within\": %f, \"time\": %f}\n", good / n, n * 0.005 }' trace.pcd > counted.json
jq -e --slurpfile c counted.json '(.within - $c[0].within | fabs) < 0.005 and (.contact_time - $c[0].time | fabs) < 0.1' report.json > ok

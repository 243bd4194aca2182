# A ramp 0.05 mm over its design in Z: d = 0.05 everywhere, the error 0.8 of it on a slope of 3:4; over-cut by as much it
# is the negative. Reference: eq. 4 to 6 by hand.
# shellcheck source=tests/fettle-verify/offset.bash
. "$HERE/offset.bash"
ramp 0.75 0 -1 11 3 > design.off
ramp 0.75 0.05 0 10 10 > high.off
ramp 0.75 -0.05 0 10 10 > low.off
fettle-verify high.off --design design.off --csv high.csv --z-errors z.pcd --ascii --report high.json > high.pcd
jq -e '.count == 200 and .undefined == 0 and (.mean - 0.04 | fabs) < 1e-12 and (.max - 0.04 | fabs) < 1e-12 and .within == 1 and
       .classes.slight_under_cut.count == 200 and (.classes.slight_under_cut.area - 125 | fabs) < 1e-9 and
       (.under_cut_volume - 5 | fabs) < 1e-9 and .over_cut_volume == 0' high.json > ok
head -n 1 high.csv
awk -F, 'NR > 1 && ($5 - 0.05 > 1e-12 || 0.05 - $5 > 1e-12 || $6 - 0.04 > 1e-12 || 0.04 - $6 > 1e-12 || $7 != "slight_under_cut") { exit 1 }
    END { if (NR != 201) exit 1 }' high.csv
grep '^FIELDS' high.pcd
awk '/^DATA/ { body = 1; next } body { n++; if ($4 - 0.05 > 1e-6 || 0.05 - $4 > 1e-6) exit 1 } END { exit n != 121 }' z.pcd
fettle-verify low.off --design design.off --report low.json > low.pcd
jq -e '(.mean + 0.04 | fabs) < 1e-12 and .classes.slight_over_cut.count == 200 and (.over_cut_volume - 5 | fabs) < 1e-9' low.json > ok

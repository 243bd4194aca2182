# Beyond the design and where it is vertical nothing is said, and that is counted, listed and grey, never 0: a box design
# 10 mm high whose walls are at x, y = 2.05 and 8.05, on a plate. Reference: counting cells. A design that is missed
# wholly: exit 1.
# shellcheck source=tests/fettle-verify/offset.bash
. "$HERE/offset.bash"
cat > design.off <<'END'
OFF
16 11 0
0 0 0
10 0 0
10 10 0
0 10 0
2.05 2.05 0
8.05 2.05 0
8.05 8.05 0
2.05 8.05 0
2.05 2.05 10
8.05 2.05 10
8.05 8.05 10
2.05 8.05 10
0 0 -1
10 0 -1
10 10 -1
0 10 -1
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
4 4 5 9 8
4 5 6 10 9
4 6 7 11 10
4 7 4 8 11
4 8 9 10 11
4 12 15 14 13
4 0 12 13 1
END
ramp 0 0.01 0.5 12.5 12 > part.off
fettle-verify part.off --design design.off --csv sheet.csv --report report.json --ascii --inner-tolerance 20 > patches.pcd 2> message
# 9 x 9 of 12 x 12 cells lie over the design; the walls run through the ring of 7 x 7 less 5 x 5 of them.
jq -e '.undefined_by_patch == {"not_hit": 126, "vertical": 48, "turned_away": 0} and .count == 114 and .undefined == 174' report.json > ok
[ "$(grep -c ',,vertical$' sheet.csv)" = 48 ]
[ "$(grep -c ',,not_hit$' sheet.csv)" = 126 ]
[ "$(awk '/^DATA/ { body = 1; next } body && $4 == "nan"' patches.pcd | wc -l)" = 174 ]
cat message
ramp 0 0 50 60 2 > far.off
status=0
fettle-verify far.off --design design.off -q --report far.json > patches.pcd || status=$?
[ $status = 1 ]
jq -e '.count == 0 and .undefined == 8 and .mean == null and .within == null' far.json > ok

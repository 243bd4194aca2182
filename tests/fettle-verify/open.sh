# Beyond the border of an open design the closest point is a place of its flank far away: nothing is said there, with either
# method. Of a closed design, and on its walls, the closest point says what is left, with the area of the machined triangles.
# Reference: the level surface 20 mm over a bowl's middle meets it on a circle of 14.1 mm; a block 2 mm wider than a design.
# shellcheck source=tests/fettle-verify/offset.bash
. "$HERE/offset.bash"
ramp 0 0 -10 10 20 | awk 'NF == 3 && NR > 2 { $3 = ($1 * $1 + $2 * $2) / 10 } { print }' > bowl.off
ramp 0 5 -20 20 20 > level.off
fettle-verify level.off --design bowl.off --report patch.json -q > patches.pcd || [ $? = 1 ]
fettle-verify level.off --design bowl.off --method closest --csv sheet.csv --report closest.json -q > closest.pcd || [ $? = 1 ]
jq -e --slurpfile patch patch.json '.count == 200 and .undefined == 600 and .undefined == .undefined_by_patch.not_hit and
    .count == $patch[0].count and .max < 5 and .min > -11' closest.json > ok
awk -F, 'NR > 1 && ($2 < -10 || $2 > 10 || $3 < -10 || $3 > 10) && $8 != "not_hit" { exit 1 }' sheet.csv
# A closed block of 10 x 10 x 5 mm on a plate; what was machined stands 1 mm over all its sides.
block() { # HALF TOP
    awk -v h="$1" -v t="$2" 'BEGIN { print "OFF\n8 12 0"
        for (k = 0; k < 8; k++) print k % 2 ? h : -h, int(k / 2) % 2 ? h : -h, k < 4 ? 0 : t
        n = split("0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5", v, " ")
        for (i = 1; i < n; i += 3) print 3, v[i], v[i + 1], v[i + 2] }'
}
block 5 5 > block.off
ramp 0 6 -6 6 12 > top.off
fettle-verify top.off --design block.off --method closest --report block.json -q > block.pcd
jq -e '.count == 288 and .undefined == 0 and .classes.serious_under_cut.count == 288 and (.classes.serious_under_cut.area - 144 | fabs) < 1e-9 and
    .undefined_by_patch.not_hit + .undefined_by_patch.vertical >= 88 and .mean >= 1' block.json > ok

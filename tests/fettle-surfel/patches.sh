# B-spline patches: a plate z = 0 with a round hole, under a block 1 mm high that ends at x = 6. Surfels beyond have no
# displacement, and none lies in the hole; a scan of the block does as well as the block.
# Reference: the circle, and the block.
# shellcheck source=tests/fettle-surfel/box.bash
. "$HERE/box.bash"
cat > plate.json <<'JSON'
{"kind": "patches", "units": {"length": "mm"}, "patches": [{"degree": [1, 1], "knots_u": [0, 0, 10, 10], "knots_v": [0, 0, 6, 6],
  "control": [[[0, 0, 0], [0, 6, 0]], [[10, 0, 0], [10, 6, 0]]], "weights": null,
  "trim": [{"degree": 1, "knots": [0, 0, 1, 2, 3, 4, 4], "control": [[0, 0], [10, 0], [10, 6], [0, 6], [0, 0]], "weights": null},
           {"degree": 2, "knots": [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], "control": [[5, 3], [5, 4], [4, 4], [3, 4], [3, 3], [3, 2], [4, 2], [5, 2], [5, 3]],
            "weights": [1, 0.7071067811865476, 1, 0.7071067811865476, 1, 0.7071067811865476, 1, 0.7071067811865476, 1]}]}]}
JSON
box -1 -1 -1 6 7 1 > stock.off # as far below the plate as above it
fettle-surfel plate.json --stock stock.off --spacing 0.25 --report report.json --ascii 2> warning > work.pcd
grep -q 'surfels miss it' warning
awk '/^[-0-9]/ && NF == 11 { if (($1 - 4) ^ 2 + ($2 - 3) ^ 2 < 0.9998) hole = 1; if ($1 < 5.99 && ($11 - 1) ^ 2 > 1e-18) off = 1
     if ($1 > 6.01 && $11 != "nan") off = 1 } END { exit hole + off }' work.pcd
jq -e '.no_hit > 400 and .no_hit < 600 and .turned_patches == 0 and .on_edges == 308 and .patches == 1' report.json > ok
# the top of the block as a scan
awk 'BEGIN { print "x y z nx ny nz"; for (i = -10; i <= 60; ++i) for (j = -10; j <= 70; ++j) print i / 10, j / 10, 1, 0, 0, 1 }' > top.xyz
fettle-surfel plate.json --stock top.xyz --spacing 0.25 --ascii -q |
    awk '/^[-0-9]/ && NF == 11 && $1 < 5.8 { if (($11 - 1) ^ 2 > 1e-12) exit 1 }'
# and as the design: thinned, with displacement 0 under itself
awk 'BEGIN { print "VERSION .7\nFIELDS x y z normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\nWIDTH 3721\nHEIGHT 1\nPOINTS 3721\nDATA ascii"
             for (i = 0; i <= 60; ++i) for (j = 0; j <= 60; ++j) print i / 10, j / 10, 0.5, 0, 0, 1 }' > scan.pcd
fettle-surfel scan.pcd --stock stock.off --spacing 0.5 --report scan.json > scan-work.pcd
jq -e '.patches == 1 and (.min - 0.5 | fabs) < 1e-9 and .max == .min and .surfels > 100 and .surfels < 200' scan.json > ok

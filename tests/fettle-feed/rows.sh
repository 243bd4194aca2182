# Rows over a plate with a wave of allowance: planned feeds, and planned forces, leave less than a third of what the best constant
# leaves; what is reported is what fettle-belt leaves with the path that comes out; limits hold; the same bytes with one thread and two.
# Reference: fettle-belt, and Preston's law for the constant: C V_b F over step-over and mean allowance.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate | awk '/^DATA/ { print; data = 1; next } data { $7 = 0.2 + 0.1 * sin($1 / 4) * cos($2 / 5) } { print }' > plate.pcd
awk 'BEGIN {
    n = 21 * 21
    printf "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz pass\nSIZE 4 4 4 4 4 4 4 4\nTYPE F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1\n"
    printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n, n
    for (j = 0; j < 21; ++j) for (i = 0; i < 21; ++i) printf "%g %g 5 1 0 0 0 %d\n", 2 * i - 20, 2 * j - 20, j }' > rows.pcd
how=(--on plate.pcd --wheel "$SAMPLES/wheels/crowned_preston.json" --cells 16)
rms() { sed '1,/^DATA/d' "$1" | awk '{ s += $7 ^ 2 } END { print sqrt(s / NR) }'; }
fettle-feed rows.pcd "${how[@]}" --force 5 --feed 5 --report feed.json > feed.pcd
jq -e '.points == 441 and .touched == 6561 and .reached == 6561 and .ratio < 0.3 and .converged and .rms_before > .rms_constant and
       (.constant / (3e-5 * 15000 * 5 / 2 / 0.2) - 1 | fabs) < 0.1' feed.json > ok
fettle-belt plate.pcd --path feed.pcd --wheel "$SAMPLES/wheels/crowned_preston.json" --cells 16 --ascii --report belt.json > planned.pcd
jq -e --argjson rms "$(rms planned.pcd)" --slurpfile belt belt.json \
    '(.rms_planned / $rms - 1 | fabs) < 1e-3 and (.time_planned / $belt[0].time - 1 | fabs) < 1e-9' feed.json > ok
fettle-belt plate.pcd --path rows.pcd --force 5 --feed "$(jq .constant feed.json)" --wheel "$SAMPLES/wheels/crowned_preston.json" --cells 16 --ascii > constant.pcd
jq -e --argjson rms "$(rms constant.pcd)" '.rms_constant / $rms - 1 | fabs < 0.01' feed.json > ok
fettle-feed rows.pcd "${how[@]}" --vary force --force 5 --feed 5 --min 2 --max 12 --ascii --report force.json > force.pcd
jq -e '.ratio < 0.3 and .at_min + .at_max < 100' force.json > ok
sed '1,/^DATA/d' force.pcd | awk '$9 < 2 - 1e-9 || $9 > 12 + 1e-9 || $10 != 5 { exit 1 }'
# Something may be left on purpose.
fettle-feed rows.pcd "${how[@]}" --force 5 --feed 5 --wanted 0.1 --rounds 1 --report wanted.json > wanted.pcd
jq -e --slurpfile all feed.json '.constant / $all[0].constant | . > 1.8 and . < 2.2' wanted.json > ok
# Points off the part, as fettle-arm leaves them between passes, change nothing, and stay without feed and force.
sed -E '/^(WIDTH|POINTS)/s/441/105/' rows.pcd | awk '!data || $8 < 5 { print } /^DATA/ { data = 1 }' > few.pcd
awk '/^(WIDTH|POINTS)/ { $2 += 5 } { print } body && $1 == 20 { print "nan nan nan nan nan nan nan", $8 } /^DATA/ { body = 1 }' few.pcd > off.pcd
by_force=("${how[@]}" --vary force --force 5 --feed 5 --rounds 1 --ascii)
fettle-feed few.pcd "${by_force[@]}" --report on.json --threads 1 > on.pcd
fettle-feed few.pcd "${by_force[@]}" --threads 2 | cmp - on.pcd
sed '1,/^DATA/d' on.pcd > on.txt
fettle-feed off.pcd "${by_force[@]}" --report off.json | sed '1,/^DATA/d' > off.txt
[ "$(grep -c '^nan nan nan .* nan nan$' off.txt)" = 5 ]
grep -v '^nan' off.txt | paste -d ' ' - on.txt | awk '{ d = ($9 - $19) / $19; if (d * d > 1e-12 || $10 != 5) exit 1 } END { exit NR != 105 }'
jq -e --slurpfile on on.json '.points == 110 and .constant == $on[0].constant' off.json > ok

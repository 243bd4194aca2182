# Rows over a plate whose allowance has waves that the wheel cannot follow: with --lower and --upper more of the area ends within than by the
# least error, and what is reported is what fettle-belt leaves. Reference: fettle-belt, counted over all surfels.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate | awk '/^DATA/ { print; data = 1; next } data { $7 = 0.15 + 0.06 * sin($1 * 1.1) * cos($2 * 0.9) } { print }' > plate.pcd
awk 'BEGIN {
    n = 9 * 9
    printf "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz pass\nSIZE 4 4 4 4 4 4 4 4\nTYPE F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1\n"
    printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n, n
    for (j = 0; j < 9; ++j) for (i = 0; i < 9; ++i) printf "%g %g 5 1 0 0 0 %d\n", 2 * i - 8, 2 * j - 8, j }' > rows.pcd
how=(--on plate.pcd --wheel "$SAMPLES/wheels/crowned_preston.json" --cells 16 --force 5 --feed 5 --wanted 0.01)
belt() { fettle-belt plate.pcd --path "$1" --wheel "$SAMPLES/wheels/crowned_preston.json" --cells 16 --ascii; }
within() { awk 'data { ++n; if ($at["displacement"] >= -0.02 && $at["displacement"] <= 0.04) ++in_range }
    $1 == "FIELDS" { for (k = 2; k <= NF; ++k) at[$k] = k - 1 } $1 == "DATA" { data = 1 } END { printf "%.6f", in_range / n }'; }
fettle-feed rows.pcd "${how[@]}" --ascii > least.pcd
fettle-feed rows.pcd "${how[@]}" --lower -0.02 --upper 0.04 --ascii --report share.json > share.pcd
least=$(belt least.pcd | within)
share=$(belt share.pcd | within)
jq -e --argjson share "$share" --argjson least "$least" '(.within_planned - $share | fabs) < 1e-5 and $share > 1.02 * $least and .within_before == 0' share.json > ok

# Rows 2 mm apart over the top of a box of 20 x 10 x 5 mm: five of 20 mm, there and back, in the middles of their strips, the
# tool's z up and its x along the feed. Made denser, the length stays; one way, every row has x the same way; turned by 90
# degrees, ten rows of 10 mm; a spiral is as long as the area over its step, less half a turn. Reference: by hand.
# shellcheck source=tests/fettle-surfel/box.bash
. "$HERE/../fettle-surfel/box.bash"
box 0 0 0 20 10 5 > design.off
box -0.3 -0.3 -0.3 20.3 10.3 5.3 > stock.off
fettle-surfel design.off --stock stock.off --spacing 0.5 > work.pcd
top() { fettle-path work.pcd --patch 1 --step-over 2 "$@"; }
top --spacing 5 --orientation along --report rows.json --ascii > rows.pcd
jq -e '.points == 25 and .passes == 5 and (.length - 100 | fabs) < 1e-6 and (.longest_step - 5 | fabs) < 1e-6 and .largest_turn_deg < 1e-6' rows.json > ok
awk 'function size(a) { return a < 0 ? -a : a }
     data { ++n; if (size($3 - 5) > 1e-5 || size($5) + size($6) > 1e-9) bad = 1; if ($8 != pass) { way = x; pass = $8 } rows[$2 + 0] = 1
            turned = size($4) < 0.5; if (turned != pass % 2) bad = 1 }
     $1 == "DATA" { data = 1 } END { for (y = 1; y < 10; y += 2) if (!(y in rows)) bad = 1; exit bad || n != 25 }' rows.pcd
# by itself the tool does not turn from row to row
top --spacing 5 --ascii | awk 'data && ($4 < 0.999 && $4 > -0.999) { exit 1 } $1 == "DATA" { data = 1 }'
fettle-path rows.pcd --spacing 0.3 --report dense.json > dense.pcd
jq -e '.points == 5 * (20 / 5 * 17 + 1) and .passes == 5 and (.length - 100 | fabs) < 1e-4 and .longest_step <= 0.3' dense.json > ok
top --one-way --spacing 5 --ascii | awk 'data && ($4 < 0.999 && $4 > -0.999) { exit 1 } $1 == "DATA" { data = 1 }'
top --along v --report v.json > v.pcd
jq -e '.passes == 10 and (.length - 100 | fabs) < 1e-4' v.json > ok
top --pattern spiral --step-over 1 --report spiral.json > /dev/null 2>&1 && exit 1 # an option given twice
fettle-path work.pcd --patch 1 --pattern spiral --step-over 1 --report spiral.json > spiral.pcd
jq -e '.passes == 1 and (.length - 199 | fabs) < 1e-4 and (.largest_turn_deg - 90 | fabs) < 1e-6' spiral.json > ok
# on the stock, 0.3 mm higher
top --on-stock --spacing 5 --ascii | awk 'data && ($3 - 5.3) ^ 2 > 1e-10 { exit 1 } $1 == "DATA" { data = 1 }'
# two patches whose u runs opposite ways: the tool is not turned from one to the other
echo '{"kind": "patches", "units": {"length": "mm"}, "patches": [
    {"degree": [1, 1], "knots_u": [0, 0, 1, 1], "knots_v": [0, 0, 1, 1], "control": [[[0, 0, 5], [0, 10, 5]], [[20, 0, 5], [20, 10, 5]]], "weights": null},
    {"degree": [1, 1], "knots_u": [0, 0, 1, 1], "knots_v": [0, 0, 1, 1], "control": [[[20, 20, 5], [20, 10, 5]], [[0, 20, 5], [0, 10, 5]]], "weights": null}]}' >two.json
box -1 -1 -1 21 21 5.3 >two.off
fettle-surfel two.json --stock two.off --spacing 0.5 | fettle-path --step-over 2 --spacing 5 --report two-report.json --ascii >two.pcd
jq -e '.passes == 10' two-report.json >ok
awk 'data { x = 1 - 2 * ($6 ^ 2 + $7 ^ 2); if (n++ && x * first < 0.99) exit 1; if (n == 1) first = x } $1 == "DATA" { data = 1 }' two.pcd

# A plate with stock on one half alone gets points no farther from it than a step-over; before a wall there are none where the wheel, less its
# layer, would be in it. Reference: by hand.
# shellcheck source=tests/fettle-surfel/box.bash
. "$HERE/../fettle-surfel/box.bash"
box 0 0 0 20 10 5 > design.off
box -0.3 -0.3 -0.3 20.3 10.3 5.3 > stock.off
fettle-surfel design.off --stock stock.off --spacing 0.5 --ascii > work.pcd
awk 'data { if ($1 > 11) $at["displacement"] = 0 } { print } $1 == "FIELDS" { for (k = 2; k <= NF; ++k) at[$k] = k - 1 } $1 == "DATA" { data = 1 }' work.pcd > half.pcd
rows() { fettle-path "$1" --patch 1 --step-over 2 --spacing 5 --ascii "${@:2}"; }
rows half.pcd --above 0.1 --report half.json > path.pcd
jq -e '.points == 15 and .passes == 5 and (.length - 50 | fabs) < 1e-4' half.json > ok
rows work.pcd --above 0.1 | cmp - <(rows work.pcd)
status=0
rows work.pcd --above 0.31 --report none.json > path.pcd || status=$?
test $status = 1
jq -e '.points == 0' none.json > ok
# The hub has a radius of 17 mm; a wall 35 mm high stands on the end of a plate 60 mm long. Over the plate the wheel gets as far as 43 mm.
{ box 0 0 0 60 10 5; box 60 0 5 61 10 40; } | awk '
    $1 == "OFF" { file++; next }
    NF == 3 && $3 == 0 && $1 == 8 { next }
    NF == 3 { vertex[n++] = $0 }
    NF == 5 { face[m++] = $1 " " $2 + 8 * (file - 1) " " $3 + 8 * (file - 1) " " $4 + 8 * (file - 1) " " $5 + 8 * (file - 1) }
    END { print "OFF\n" n, m, 0; for (i = 0; i < n; ++i) print vertex[i]; for (i = 0; i < m; ++i) print face[i] }' > corner.off
fettle-surfel corner.off --stock corner.off --spacing 1 -q > corner.pcd
farthest() { awk 'data && $3 > 4.999 && $3 < 5.001 && $4 > 0.999 { if ($1 > max) max = $1 } $1 == "DATA" { data = 1 } END { print max }' "$1"; }
fettle-path corner.pcd --step-over 2 --spacing 1 --ascii > all.pcd
fettle-path corner.pcd --step-over 2 --spacing 1 --room-for "$SAMPLES/wheels/crowned_preston.json" --ascii > room.pcd
[ "$(farthest all.pcd)" = 60 ]
[ "$(farthest room.pcd)" = 43 ]
# What has no room is the rest.
fettle-path corner.pcd --step-over 2 --spacing 1 --no-room-for "$SAMPLES/wheels/crowned_preston.json" --ascii > no-room.pcd
count() { sed -n 's/^POINTS //p' "$1"; }
[ $(($(count room.pcd) + $(count no-room.pcd))) = "$(count all.pcd)" ]
awk 'data && $3 > 4.999 && $3 < 5.001 && $4 > 0.999 && $1 < 43.5 { exit 1 } $1 == "DATA" { data = 1 }' no-room.pcd

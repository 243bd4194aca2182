# A robot with slow joints takes its time: nowhere is a joint faster than its file allows, though the same moves at the gantry's speeds would be; feeds are lowered, and
# the part still comes out within its tolerance of 0.1 mm. References: the joints and times that moved, judged by fettle-arm; the plane at z = 5.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 1
make_place 25
kLimits='1 0.7 0.7 2 2 2' # degrees per second
jq --arg limits "$kLimits" '($limits | split(" ") | map(tonumber)) as $l | .dh |= [range(6) as $i | .[$i] + {max_speed_deg: $l[$i]}]' "$ROBOT" > slow.json
for robot in "$ROBOT" slow.json; do
    name=$(basename "$robot" .json)
    fettle-grind plan.json --stock stock.stl --cell 0.2 --place place.txt --report $name-grind.json --ascii \
        --gantry "exec:fettle-gantry-robot $robot plan.json --stock stock.stl --cell 0.2 --moves $name.pcd --report $name-moves.json" > $name-ground.pcd
    jq -e .finished $name-grind.json > ok
    awk '/^DATA/ { body = 1; next } body && $1 > -6 && $1 < 6 && $2 > -6 && $2 < 6 { if ($3 > 5.1 || $3 < 4.99) exit 1; ++n } END { exit n < 3000 }' $name-ground.pcd
done
jq -e '.reached == .count and ([.joints[].too_fast] | add) == 0' slow-moves.json > ok || { cat slow-moves.json; exit 1; }
fettle-arm slow.json --forward slow.pcd --report judged.json -q -o ground.csv
jq -e '([.joints[].too_fast] | add) == 0 and .time > 0' judged.json > ok || { cat judged.json; exit 1; }
if fettle-arm slow.json --forward irb1400_wheel.pcd --report judged.json -q -o ground.csv; then exit 1; fi
jq -e '([.joints[].too_fast] | add) > 100' judged.json > ok
# Slowly moved the wheel takes more at a time: it needs fewer coverings, before each of which it is measured for 10 s.
jq -es 'map(.machine_time - 10 * .touch_offs) | .[0] > 1.3 * .[1]' slow-grind.json irb1400_wheel-grind.json > ok

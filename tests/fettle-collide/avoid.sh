# A clamp obstructs the tool along the keel: the path is changed to avoid it. The ball's centre, and so the point of contact,
# stays where it is but for retreats. Reference: the path itself, and a second check of the changed path.
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
jq '.bodies += [{name: "clamp", link: -1, shape: "box", at: {position: [1065, 1000, 600]}, size: [60, 60, 200]}]' \
    "$SAMPLES/robots/irb1400.json" >clamp.json
path=$SAMPLES/paths/keel.pcd
look() { fettle-collide clamp.json "$1" --workpiece keel.stl --track 350 --resolution 1 --report "$2" -q --ascii "${@:3}"; }
status=0
look "$path" before.json -o before.pcd || status=$?
test $status -eq 1
jq -e '.collisions > 5 and (.min.pair | index("clamp") != null)' before.json >/dev/null

centres() { # of the ball: 6 mm up the tool's axis; and how far it is drawn back
    awk -v OFMT=%.5f 'd { w = $4; x = $5; y = $6; z = $7; print $1 + 12 * (x * z + w * y), $2 + 12 * (y * z - w * x), $3 + 6 * (1 - 2 * (x * x + y * y)), $NF }
         $1 == "DATA" { d = 1 }' "$1"
}
centres "$path" | cut -d' ' -f1-3 >given
for how in pose smooth; do
    look "$path" $how.json --avoid $how -o $how.pcd || test $? -eq 1
    jq -e '.collisions == 0 and .avoidance.unsolved == 0 and .avoidance.tilted >= $before[0].collisions and
        .avoidance.changed == (.avoidance.changes | length) and (.avoidance.unsolved_poses | length) == 0 and
        .avoidance.max_tilt_deg <= 45.001 and .avoidance.max_retreat <= 1.001' --slurpfile before before.json $how.json >/dev/null
    centres $how.pcd | paste -d' ' given - | awk '{ d = sqrt(($1 - $4)^2 + ($2 - $5)^2 + ($3 - $6)^2); if (d > $7 + 2e-3) { print; exit 1 } }'
    # the changed poses are clear when they are checked again
    sed 's/ joint/ j/g' $how.pcd >again.pcd
    look again.pcd again.json -o /dev/null || test $? -eq 1
    jq -e '.collisions == 0 and .reached == 61' again.json >/dev/null
done
# smoothly the tilt changes by less than a third as much from pose to pose, and the ways between are clear, too
jq -es '.[1].avoidance.max_tilt_change_deg <= 0.3 * .[0].avoidance.max_tilt_change_deg' pose.json smooth.json >/dev/null
jq -e '.avoidance.by == "smooth" and .avoidance.unsolved_ways == .collisions_between' smooth.json >/dev/null
# --avoid alone is pose by pose, in any position; the same bytes for any number of threads
fettle-collide --avoid clamp.json "$path" --workpiece keel.stl --track 350 --resolution 1 -q --ascii --threads 1 | cmp - pose.pcd
fettle-collide clamp.json "$path" --workpiece keel.stl --track 350 --resolution 1 -q --ascii --threads 1 --avoid=smooth | cmp - smooth.pcd
# with less tilt it cannot be done: exit 1, and which poses
status=0
look "$path" little.json --avoid --max-tilt 5 -o little.pcd || status=$?
test $status -eq 1
jq -e '.avoidance.unsolved > 0 and .avoidance.unsolved == .collisions and (.avoidance.unsolved_poses[0].pair | index("clamp") != null)' little.json >/dev/null
# nothing to avoid: nothing is changed
fettle-collide "$SAMPLES/robots/irb1400.json" "$path" --workpiece keel.stl --avoid --report none.json -q -o /dev/null
jq -e '.avoidance.changed == 0 and .collisions == 0 and .collisions_between == 0' none.json >/dev/null

# Every field of a checked and changed path, and every key of the reports of fettle-collide and fettle-arm, scales as its dimension
# when the same path is in inches or metres.
fettle-part "$SAMPLES/parts/keel.json" > keel.stl
jq '.bodies += [{name: "clamp", link: -1, shape: "box", at: {position: [1065, 1000, 600]}, size: [60, 60, 200]}]' \
    "$SAMPLES/robots/irb1400.json" > clamp.json
sed -E '/^(WIDTH|POINTS)/s/61/13/' "$SAMPLES/paths/keel.pcd" | awk 'data && n++ % 5 { next } { print } $1 == "DATA" { data = 1 }' > mm.pcd
convert() { # UNIT PER
    awk -v per="$2" -v unit="$1" '/^# units/ { print "# units", unit; next } data { $1 *= per; $2 *= per; $3 *= per } $1 == "DATA" { data = 1 } { print }' \
        CONVFMT=%.9g OFMT=%.9g mm.pcd > "$1.pcd"
}
convert in 0.0393700787
convert m 0.001
{
    printf '%s 1\n' x y z foot_x foot_y foot_z clearance clearance_between joint7 retreat avoidance.{max_retreat,changes.{retreat,clearance,clearance_before}} \
        avoidance.unsolved_poses.clearance colliding.min_clearance tolerance max_missed_depth cell cuboids_too_near {min,min_between}.{clearance,point} \
        joints.joint7.{min,max,max_speed,max_acceleration} track.value
    printf '%s 0\n' qw qx qy qz joint{1,2,3,4,5,6} state singularity body other avoided tilt tilt_towards t time grids \
        avoidance.{changed,tilted,drawn_back,unsolved,unsolved_ways,max_tilt_deg,max_tilt_change_deg,changes.{pose,tilt_deg,towards_deg}} \
        avoidance.unsolved_poses.pose colliding.poses {min,min_between}.{pose,time} checked collisions collisions_between midpoints_checked \
        count reached unreachable out_of_range undefined jumps singular min_singularity min_singularity_at \
        joints.joint{1,2,3,4,5,6}.{min,max,max_speed,max_acceleration} joints.joint{1,2,3,4,5,6,7}.{out_of_range,max_speed_at,max_acceleration_at,too_fast}
} | jq -R 'split(" ") | {(.[0]): (.[1] | tonumber)}' | jq -s add > powers
check() { # UNIT TRACK STEP FEED
    fettle-collide clamp.json "$1.pcd" --workpiece keel.stl --workpiece-units mm --track "$2" --avoid --max-tilt 10 --method grid --max-retreat "$3" \
        --report "$1.json" -q --ascii -o "$1.checked.pcd" || [ $? = 1 ]
    fettle-arm clamp.json --inverse "$1.pcd" --track "$2" --feed "$4" --report "$1.arm.json" -q --ascii -o "$1.arm.pcd" || [ $? = 1 ]
}
check mm 350 30 50
check in 13.7795276 1.18110236 1.96850394
check m 0.35 0.03 0.05
jq -e '.avoidance.max_retreat > 0 and (.avoidance.changes | length) > 0' mm.json > ok
for file in checked.pcd json arm.pcd arm.json; do
    "$HERE/../scales" in "$(cat powers)" mm.$file in.$file
    "$HERE/../scales" m "$(cat powers)" mm.$file m.$file
done

# A ball that runs 0.02 mm clear along the keel of a sheet touches nothing; 0.1 mm lower it gouges by 0.08. Reference: the arc itself.
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
robot=$SAMPLES/robots/irb1400.json
fettle-arm "$robot" --inverse "$SAMPLES/paths/keel.pcd" --feed 50 -q -o joints.pcd
fettle-collide "$robot" joints.pcd --workpiece keel.stl --report r.json -q --ascii >clear.pcd
# chords of 5 mm lie 0.006 mm below the arc
jq -e '.collisions == 0 and .collisions_between == 0 and .checked == 61 and .min.pair == ["ball", "workpiece"] and
    .min.clearance > 0.0195 and .min.clearance < 0.027 and (.max_missed_depth - 0.06 | fabs) < 1e-12' r.json >/dev/null
# poses or joints: the same
fettle-collide "$robot" "$SAMPLES/paths/keel.pcd" --workpiece keel.stl --report poses.json -q -o /dev/null
jq -es '.[0].min.clearance - .[1].min.clearance | fabs < 2e-4' r.json poses.json >/dev/null
# the same bytes for any number of threads
fettle-collide "$robot" joints.pcd --workpiece keel.stl --threads 1 -q --ascii | cmp - clear.pcd

fettle-arm "$robot" --forward joints.pcd --ascii | awk 'data { $3 -= 0.1 } { print } $1 == "DATA" { data = 1 }' |
    sed 's/joint/j/g' >low.pcd
status=0
fettle-collide "$robot" low.pcd --workpiece keel.stl --report r.json -q --ascii >gouge.pcd || status=$?
test $status -eq 1
jq -e '.collisions == 61 and .min.pair == ["ball", "workpiece"] and .min.clearance < -0.07 and .min.clearance > -0.085 and
    .min.time >= 0 and (.colliding | length) == 1 and .colliding[0].poses == 61' r.json >/dev/null
# a gouge as deep as the tolerance is a contact; half-way between poses 10 mm apart the ball is 0.025 deeper
fettle-collide "$robot" low.pcd --workpiece keel.stl --tolerance 0.11 --report r.json -q -o /dev/null
jq -e '.collisions == 0 and .collisions_between == 0' r.json >/dev/null
# the spindle is held off by a margin, the ball is not
jq '.margins = [{a: "spindle", b: "workpiece", distance: 60}]' "$robot" >margin.json
fettle-collide margin.json joints.pcd --workpiece keel.stl --report m.json --beyond 100 -q -o /dev/null || test $? -eq 1
fettle-collide "$robot" joints.pcd --beyond 100 --report none.json -q -o /dev/null
jq -e '.min.pair == ["spindle", "workpiece"]' m.json >/dev/null
# a calibration error takes as much from the clearances of the robot to all else, but not of a pair that has its margin
min_clearance() { fettle-collide "$1" joints.pcd --workpiece keel.stl --report l.json -q -o /dev/null "${@:2}" || test $? -eq 1; jq -c '[.min.clearance, .min.pair]' l.json; }
jq '.calibration_error = 0.5' "$robot" >error.json
jq '.margins = [{a: "ball", b: "workpiece", distance: 0}]' error.json >but.json
jq '.allowed += [["ball", "workpiece"], ["shank", "workpiece"]]' "$robot" >free.json
jq '.calibration_error = 0.5' free.json >free_error.json
jq -e -n --argjson a "$(min_clearance "$robot")" --argjson b "$(min_clearance error.json)" --argjson c "$(min_clearance but.json)" --argjson d "$(min_clearance free.json)" --argjson e "$(min_clearance free_error.json)" \
    '($a[0] - $b[0] - 0.5 | fabs) < 1e-9 and $a == $c and ($d[0] - $e[0] - 0.5 | fabs) < 1e-9 and $d[1] == $e[1]' >/dev/null

# Everything refused: exit 2, one line that names the file or option and the value, nothing on stdout.
refuses() { "$HERE/../refuses" "$@" </dev/null; }
robot=$SAMPLES/robots/irb2400.json
cp "$SAMPLES/robots/irb1400.json" good.json
cp "$SAMPLES/paths/keel.pcd" path.pcd
: >empty
refuses 'empty: ' fettle-arm empty --inverse path.pcd
refuses 'empty: ' fettle-arm good.json --inverse empty
sed '/^DATA/q; s/61/0/' path.pcd >none.pcd
refuses 'none.pcd: needs at least 1 point, got 0' fettle-arm good.json --inverse --feed 1 --rapid out.mod none.pcd
refuses 'missing.json' fettle-arm missing.json --inverse path.pcd
refuses 'one of --forward, --inverse and --reach' fettle-arm good.json path.pcd
refuses 'one of --forward, --inverse and --reach' fettle-arm good.json --forward --inverse path.pcd
refuses '--all goes with --inverse' fettle-arm good.json --forward --all path.pcd
refuses '--box goes with --reach' fettle-arm good.json --inverse --box 0,0,0,1,1,1 path.pcd
refuses '--rapid needs a path' fettle-arm good.json --reach --box 0,0,0,1,1,1 --feed 1 --rapid out.mod
refuses '--rapid needs --feed' fettle-arm good.json --inverse --rapid out.mod path.pcd
refuses "path.pcd: the points have no field 'joint1'" fettle-arm good.json --forward path.pcd
joints() { # NAME JOINT1 JOINT7
    printf 'VERSION 0.7\nFIELDS joint1 joint2 joint3 joint4 joint5 joint6 joint7\nSIZE 8 8 8 8 8 8 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n' > "$1"
    printf 'WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n0 0 0 0 0 0 0\n%s 0 0 0 0 0 %s\n' "$2" "$3" >> "$1"
}
joints turned.pcd 1e9 0
refuses 'turned.pcd: point 1: joint1 is 1e+09 degrees, at most 720 either way' fettle-arm good.json --forward turned.pcd
joints away.pcd 0 -1e9
refuses 'away.pcd: point 1: joint7 is -1e+09 mm, at most 100000 either way' fettle-arm good.json --forward away.pcd
sed 's/joint1/jointA/' turned.pcd >no_joint1.pcd
refuses "no_joint1.pcd: the points have no field 'joint1'" fettle-arm good.json --forward no_joint1.pcd
sed 's/ qz$/ qq/' path.pcd >no_qz.pcd
refuses "no_qz.pcd: the points have no field 'qz'" fettle-arm good.json --inverse no_qz.pcd
sed '$s/.*/1000 1000 500 0 0 0 0/' path.pcd >zero.pcd
refuses 'zero.pcd: point 60: the quaternion qw qx qy qz is 0' fettle-arm good.json --inverse zero.pcd
refuses "--track: expected auto, a number or follow:NUMBER, got 'there'" fettle-arm good.json --inverse --track there path.pcd
refuses '--track: the robot has none' fettle-arm "$robot" --inverse --track 0 path.pcd
refuses '--table: the robot has none' fettle-arm good.json --inverse --table follow:0 path.pcd
for start in 1,2,3 1,2,3,4,5,1e9 1,2,3,4,5,6,7 1,2,3,4,5,x 1,2,3,4,5,nan; do
    refuses '--start: expected six angles' fettle-arm good.json --inverse --start "$start" path.pcd
done
for box in 0,0,0,1,1 0,0,0,1,1,1,1 0,0,0,1,1,-1 0,0,0,1,1,x 0,0,0,1,1,inf; do
    refuses '--box: expected x,y,z of its minimum and of its maximum corner' fettle-arm good.json --reach --box $box
done
refuses '--box: expected' fettle-arm good.json --reach
refuses 'the box has 1e+09 cells, at most 1e+07' fettle-arm good.json --reach --box 0,0,0,1000,1000,1000 --step 1
refuses '--feed' fettle-arm good.json --inverse --feed 0 path.pcd
refuses '--jump' fettle-arm good.json --inverse --jump -1 path.pcd
refuses '--singular' fettle-arm good.json --inverse --singular 2 path.pcd
refuses 'path.pcd: units: the file says mm, expected in' fettle-arm good.json --inverse --file-units in path.pcd

# the robot file: MESSAGE JQ-CHANGE
change() {
    jq "$2" good.json >bad.json
    refuses "bad.json: $1" fettle-arm bad.json --inverse path.pcd
}
change 'kind: expected "robot", got "job"' '.kind = "job"'
change 'units' 'del(.units)'
change 'dh: expected a row for each of 6 joints, got 5' 'del(.dh[5])'
change 'dh[0].alpha_deg: the inverse has a closed form only with 90 or -90 here' '.dh[0].alpha_deg = 80'
change 'dh[1].alpha_deg: the inverse has a closed form only with axes 2 and 3 parallel: 0' '.dh[1].alpha_deg = 90'
change 'dh[1].a: the inverse has a closed form only with an upper arm: not 0' '.dh[1].a = 0'
change 'dh[3].d: the inverse has a closed form only with a forearm' '.dh[3].d = 0 | .dh[2].a = 0'
change 'dh[4].a: the inverse has a closed form only with a spherical wrist: 0' '.dh[4].a = 1'
change 'dh[4].d: the inverse has a closed form only with a spherical wrist: 0' '.dh[4].d = 1'
change 'dh[2].max_deg: must be at least min_deg, 80, got 70' '.dh[2].min_deg = 80'
change 'dh[2].min_deg: must be' '.dh[2].min_deg = -1000'
change 'dh[2].max_speed_deg: must be positive, got 0' '.dh[2].max_speed_deg = 0'
change 'dh[2].b: unknown' '.dh[2].b = 1'
change 'coupling: ' '.coupling = "paralelogram"'
change 'coupling: missing' 'del(.coupling)'
change 'tool.d: must be' '.tool.d = 1e9'
change 'track.axis: a direction must not be 0' '.track.axis = [0, 0, 0]'
change 'track.max: must be at least min' '.track.max = -1'
change "bodies[1].name: another body is called 'turret', too" '.bodies[0].name = "turret"'
change 'bodies[0].link: must be' '.bodies[0].link = 9'
change 'bodies[0].link: 8 is the table, and the robot has none' '.bodies[0].link = 8'
change 'bodies[0].shape: ' '.bodies[0].shape = "torus"'
change 'bodies[0].radius: must be' '.bodies[0].radius = 0'
change 'bodies[0].to: equals from' '.bodies[0].to = .bodies[0].from'
change 'bodies[0].size: ' '.bodies[0] |= {name, link, shape: "box", size: [1, 1, -1], at: {}}'
change 'bodies[0].at.quaternion: must not be 0' '.bodies[0] |= {name, link, shape: "box", size: [1, 1, 1], at: {quaternion: [0, 0, 0, 0]}}'
change 'bodies[0].radius_to: both radii are 0' '.bodies[0] |= (del(.radius) + {shape: "cone", radius_from: 0, radius_to: 0})'
change "allowed[0]: no body is called 'turet', did you mean 'turret'?" '.allowed = [["turet", "base"]]'
change "allowed[0]: expected two bodies, got 'base' twice" '.allowed = [["base", "base"]]'
change 'allowed[0]: expected 2 texts' '.allowed = [["base"]]'
change 'margins[0].distance: must be' '.margins = [{a: "base", b: "bench", distance: -1}]'
jq '.bodies[0] |= {name, link, shape: "hull", file: "nothing.stl"}' good.json >bad.json
refuses 'nothing.stl' fettle-arm bad.json --inverse path.pcd

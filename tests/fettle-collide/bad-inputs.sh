# Everything refused: exit 2, one line that names the file or option and the value, nothing on stdout.
refuses() { "$HERE/../refuses" "$@" </dev/null; }
cp "$SAMPLES/robots/irb1400.json" robot.json
cp "$SAMPLES/paths/keel.pcd" path.pcd
: >empty
refuses 'robot.json: JSON, expected a mesh' fettle-collide robot.json path.pcd --workpiece robot.json
refuses 'empty: ' fettle-collide empty path.pcd
refuses 'empty: ' fettle-collide robot.json empty
refuses 'empty' fettle-collide robot.json path.pcd --workpiece empty
sed '/^DATA/q; s/61/0/' path.pcd >none.pcd
refuses 'none.pcd: needs at least 1 point, got 0' fettle-collide robot.json none.pcd
refuses 'missing.stl' fettle-collide robot.json path.pcd --workpiece missing.stl
sed 's/ qz$/ qq/' path.pcd >no_qz.pcd
refuses "no_qz.pcd: the points have no field 'qz'" fettle-collide robot.json no_qz.pcd
sed 's/ qz$/ joint1/' path.pcd >joints.pcd
refuses "joints.pcd: the points have no field 'joint2'" fettle-collide robot.json joints.pcd
refuses '--tolerance' fettle-collide robot.json path.pcd --tolerance -1
refuses '--beyond' fettle-collide robot.json path.pcd --beyond 0
refuses '--resolution' fettle-collide robot.json path.pcd --resolution 0
refuses '--track: expected auto' fettle-collide robot.json path.pcd --track x
refuses '--table: the robot has none' fettle-collide robot.json path.pcd --table 5
jq '.bodies[0].name = "workpiece"' robot.json >named.json
refuses 'named.json: bodies[0].name: is reserved for the part' fettle-collide named.json path.pcd
# an unreachable pose: the answer is no, and its clearance is not known
sed '$s/^1000/9000/' path.pcd >far.pcd
status=0
fettle-collide robot.json far.pcd --report r.json --ascii >far.out || status=$?
test $status -eq 1
jq -e '.reached == 60 and .checked == 60 and .unreachable == 1' r.json >/dev/null
tail -n 1 far.out | grep -q nan
refuses "--avoid: 'smoot' is none of pose, smooth; did you mean 'smooth'" fettle-collide robot.json path.pcd --avoid=smoot
refuses '--max-tilt' fettle-collide robot.json path.pcd --avoid --max-tilt 91
refuses '--max-retreat' fettle-collide robot.json path.pcd --avoid --max-retreat -1
refuses 'twice' fettle-collide robot.json path.pcd --avoid --avoid smooth
# A flat body, two triangles in a plane: its hull has no inside, and it touches the keel without a depth. It took half a minute.
printf 'OFF\n4 2 0\n-200 -200 20\n200 -200 20\n200 200 20\n-200 200 20\n3 0 1 2\n3 0 2 3\n' >sheet.off
jq '.bodies += [{name: "sheet", link: 7, shape: "hull", file: "sheet.off"}]' robot.json >sheet.json
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
timeout $((20 * ${FETTLE_PATIENCE:-1})) fettle-collide sheet.json path.pcd --workpiece keel.stl --report sheet-report.json -q -o /dev/null || test $? -eq 1
jq -e '.min.clearance <= 0 and .min.clearance > -1e-3 and (.min.pair | index("sheet") != null)' sheet-report.json >/dev/null

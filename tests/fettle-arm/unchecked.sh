# A program is written of a checked path alone, with the joints that were checked; --unchecked writes others, too, and says so first.
# Reference: by hand.
refuses() { "$HERE/../refuses" "$@" </dev/null; }
robot=$SAMPLES/robots/irb1400.json
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
path=$SAMPLES/paths/keel.pcd
refuses 'the path is not checked for collisions: fettle-collide with a --workpiece checks it; --unchecked' fettle-arm "$robot" --inverse "$path" --feed 50 --rapid p.mod
test ! -e p.mod
fettle-arm "$robot" --inverse "$path" --feed 50 --unchecked --rapid p.mod --krl p.src --ls p.ls --urscript p.script -q -o /dev/null
head -n 1 p.mod | grep -q UNCHECKED
head -n 1 p.src | grep -q UNCHECKED
head -n 1 p.script | grep -q UNCHECKED
grep -A1 '^/MN' p.ls | grep -q '1:  !UNCHECKED'
fettle-collide "$robot" "$path" --workpiece keel.stl -q --ascii -o checked.pcd
for way in --inverse --forward; do
    fettle-arm "$robot" $way checked.pcd --feed 50 --unchecked --krl p.src -q -o /dev/null
    head -n 1 p.src | grep -q 'checked: clearance 0.0' || { head -n 1 p.src; exit 1; }
done
# a point that was moved, another robot, other joints
sed '$s/^\([^ ]*\) /\11 /' checked.pcd >moved.pcd
refuses 'moved.pcd: the path or the robot has changed since it was checked' fettle-arm "$robot" --forward moved.pcd --feed 50 --rapid p2.mod
jq '.tool.d += 1' "$robot" >other.json
refuses 'the path or the robot has changed since it was checked' fettle-arm other.json --forward checked.pcd --feed 50 --rapid p2.mod
refuses 'pose 0: joint 1 is at -17.613, and was checked at 13.0904' fettle-arm "$robot" --inverse checked.pcd --track 900 --feed 50 --rapid p2.mod
sed 's/^# checked .*/# checked by me/' checked.pcd >forged.pcd
refuses "'checked by me' is no stamp of a checked path" fettle-arm "$robot" --forward forged.pcd --feed 50 --rapid p2.mod
# a clearance that was edited; a robot with nothing that could touch the part; a part that is inside out
sed 's/ clearance [-0-9.e]* / clearance 25 /' checked.pcd >better.pcd
refuses 'better.pcd: the path or the robot has changed since it was checked' fettle-arm "$robot" --forward better.pcd --feed 50 --rapid p2.mod
jq '.bodies |= map(select(.link < 6)) | .allowed = []' "$robot" >bare.json
fettle-collide bare.json "$path" --workpiece keel.stl -q -v --report bare-report.json -o bare.pcd 2>said
jq -e '.stamped == false' bare-report.json >ok
refuses 'bare.pcd: the path is not checked for collisions' fettle-arm bare.json --forward bare.pcd --feed 50 --rapid p2.mod

# The robot's program of a path, in RAPID. Reference: recorded; its targets are the path's points, its first joints those of --inverse.
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
fettle-collide "$SAMPLES/robots/irb1400.json" "$SAMPLES/paths/keel.pcd" --workpiece keel.stl -q -o checked.pcd
fettle-arm "$SAMPLES/robots/irb1400.json" --inverse checked.pcd --feed 50 --rapid keel.mod --ascii -o joints.pcd
test "$(grep -c 'CONST robtarget' keel.mod)" -eq 61
awk 'data { printf "%.3f %.3f %.3f\n", $1, $2, $3 } $1 == "DATA" { data = 1 }' "$SAMPLES/paths/keel.pcd" >points
sed -n 's/.*robtarget p[0-9]* := \[\[\([^]]*\)\].*/\1/p' keel.mod | awk -F, '{ printf "%.3f %.3f %.3f\n", $1, $2, $3 }' | diff points -
sed -n '1,10p; /PROC main/,/MoveL p2/p; /p61,/,$p' keel.mod

# The robot's program of a path, in RAPID. Reference: recorded; its targets are the path's points, its first joints those of --inverse.
fettle-arm "$SAMPLES/robots/irb1400.json" --inverse "$SAMPLES/paths/keel.pcd" --feed 50 --rapid keel.mod --ascii -o joints.pcd
test "$(grep -c 'CONST robtarget' keel.mod)" -eq 61
awk 'data { printf "%.3f %.3f %.3f\n", $1, $2, $3 } $1 == "DATA" { data = 1 }' "$SAMPLES/paths/keel.pcd" >points
sed -n 's/.*robtarget p[0-9]* := \[\[\([^]]*\)\].*/\1/p' keel.mod | awk -F, '{ printf "%.3f %.3f %.3f\n", $1, $2, $3 }' | diff points -
sed -n '1,8p; /PROC main/,/MoveL p2/p; /p61,/,$p' keel.mod

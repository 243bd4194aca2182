# From a scan to a checked robot program, through the make file: every anomaly with a job has a routine of its own, and the robot's tip comes where the
# wheel of the gantry would. Reference: the surface that was fitted, the lengths of the travel, the numbers of the report.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-find)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/cell.mk B="$build" CELL="$PWD/cell" > table 2> warnings || { cat table warnings; exit 1; }
cat table
rows=$(jq '[.anomalies[] | select(.job != "")] | length' cell/found.json)
[ "$rows" -ge 2 ]
[ "$(grep -c ': ground$' table)" = "$rows" ]
[ "$(grep -c '^  PROC ' cell/program.mod)" = $((rows + 1)) ]
head -n 1 cell/program.mod | grep -q '! checked: clearance'
awk '/^# checked/ { exit !($8 > 15) }' cell/checked.pcd
[ -s cell/cell.png ]
# Back in the first anomaly's job, its layer 1: the wheel's lowest line is on the surface, or above it where the surface is hollow; and layer 2 above layer 1.
row=$(jq '[.anomalies[] | select(.job != "")][0].anomaly' cell/found.json)
fettle-place cell/path.pcd --into "cell/jobs/$row.json" -o back.csv
columns() { awk -F , -v want="$1" -v row="$row" 'NR == 1 { for (i = 1; i <= NF; ++i) c[$i] = i; print "x,y,z"; next } $c["anomaly"] == row && $c["motion"] == 0 && $c["layer"] == want { print $c["x"] "," $c["y"] "," $c["z"] }' back.csv; }
columns 1 > tips.csv
columns 2 > above.csv
[ "$(wc -l < tips.csv)" -gt 100 ]
[ "$(wc -l < tips.csv)" = "$(wc -l < above.csv)" ]
fettle-mesh "cell/$row/desired.json" --at tips.csv -o surface.csv
paste -d , tips.csv surface.csv above.csv | awk -F , 'NR > 1 { d = $3 - $6; if (d < -0.01 || d > 0.2) exit 1 }'
# The strategy on the robot, at the smallest anomaly: it leaves the part of the gantry, within the ranges of the joints, and nothing collides. That a changed part would be told: one of which a
# point is 0.01 mm lower, and a robot that may not bend its wrist, which is refused before it grinds.
small=$(jq '[.anomalies[] | select(.job != "")] | min_by(.area).anomaly' cell/found.json)
strategy() { make --no-print-directory -s -C "$root" -f pipelines/cell.mk B="$build" CELL="$PWD/cell" ROWS="$small" "$@"; }
strategy strategy > table 2> warnings || { cat table warnings; exit 1; }
grep "^anomaly $small: ground by the robot within its joints' ranges; its part differs from the gantry's by 0 mm$" table
grep '^  0 collide, 0 ways between them; least clearance [0-9]' table
jq -e '.count > 100 and .reached == .count and .jumps == []' "cell/$small/robot/moves.json" > ok
"$root/pipelines/cell-strategy" cell > again
fettle-place "cell/$small/robot/ground.pcd" --matrix <(printf '1 0 0 0\n0 1 0 0\n0 0 1 0.01\n0 0 0 1\n') -q -o lower.pcd
mv lower.pcd "cell/$small/robot/ground.pcd"
if "$root/pipelines/cell-strategy" cell > again; then exit 1; fi
rm "cell/$small/robot/ground.pcd"
jq '.dh[4].min_deg = -20 | .dh[4].max_deg = 20' "$SAMPLES/robots/irb1400_wheel.json" > stiff.json
if strategy strategy ROBOT="$PWD/stiff.json" > table 2> warnings; then exit 1; fi
grep -q "does not take the job's frame: the pose at .* mm: joint 5 would be at .* degrees, out of its range of -20 to 20, with the track at " warnings
[ ! -e "cell/$small/robot/ground.pcd" ]

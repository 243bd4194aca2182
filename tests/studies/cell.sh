# From a scan to a checked robot program, through the make file: every anomaly with a job has a routine of its own, and the robot's tip comes where the
# wheel of the gantry would. Reference: the surface that was fitted, the lengths of the travel, the numbers of the report.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-find)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/cell.mk B="$build" CELL="$PWD/cell" > table 2> warnings || { cat table warnings; exit 1; }
cat table
rows=$(jq '[.anomalies[] | select(.job != "")] | length' cell/found.json)
[ "$rows" -ge 2 ] && [ "$(grep -c ': ground$' table)" = "$rows" ]
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
[ "$(wc -l < tips.csv)" -gt 100 ] && [ "$(wc -l < tips.csv)" = "$(wc -l < above.csv)" ]
fettle-mesh "cell/$row/desired.json" --at tips.csv -o surface.csv
paste -d , tips.csv surface.csv above.csv | awk -F , 'NR > 1 { d = $3 - $6; if (d < -0.01 || d > 0.2) exit 1 }'

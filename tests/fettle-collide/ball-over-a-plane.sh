# The ball of a tool that leans over a level plate is as far from it as its centre, less its radius: the tip plus 6 mm along the tool, less 6 mm.
# Reference: by hand, from the quaternions of the path; 1e-3 mm is the rounding of the joints' and the path's floats at 1 m.
robot=$SAMPLES/robots/irb1400.json path=$SAMPLES/paths/keel.pcd
jq '.bodies |= map(select(.name == "ball")) | .allowed = []' "$robot" > ball.json
lowest=$(sed '1,/^DATA/d' "$path" | sort -g -k 3 | awk 'NR == 1 { print $3 }')
z=$(awk -v z="$lowest" 'BEGIN { print z - 1.5 }')
printf 'OFF\n4 2 0\n900 600 %s\n1100 600 %s\n1100 1400 %s\n900 1400 %s\n3 0 1 2\n3 0 2 3\n' "$z" "$z" "$z" "$z" > plate.off
fettle-collide ball.json "$path" --workpiece plate.off --beyond 500 -q --ascii > checked.pcd || [ $? = 1 ]
column() { awk -v name="$1" '/^FIELDS/ { for (i = 2; i <= NF; ++i) if ($i == name) column = i - 1 } body { print $column } /^DATA/ { body = 1 }' "$2"; }
as_json() { jq -cs '{clearance: .}'; }
[ "$(column body checked.pcd | sort -u | wc -l)" = 1 ] # the ball's, at every pose
sed '1,/^DATA/d' "$path" | awk -v z="$z" '{ up = 1 - 2 * ($5 * $5 + $6 * $6); printf "%.9f\n", $3 + 6 * up - 6 - z }' | as_json > expected.json
[ "$(jq '.clearance | length' expected.json)" = 61 ]
column clearance checked.pcd | as_json | fettle-diff - expected.json --tol 1e-3

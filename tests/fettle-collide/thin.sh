# A rod between two poses that are both clear of it is not missed. Reference: its place, half-way between the tips.
cat >two.pcd <<'P'
VERSION 0.7
FIELDS x y z joint1 joint2 joint3 joint4 joint5 joint6 joint7
SIZE 4 4 4 8 8 8 8 8 8 8
TYPE F F F F F F F F F F
COUNT 1 1 1 1 1 1 1 1 1 1
WIDTH 2
HEIGHT 1
POINTS 2
DATA ascii
0 0 0 -3 10 20 0 60 0 0
0 0 0 3 10 20 0 60 0 0
P
fettle-arm "$SAMPLES/robots/irb1400.json" --forward two.pcd --ascii | awk '
    data { x = $1; z = $3 } $1 == "DATA" { data = 1 } END { print x * 1.0005, z + 20 }' >place
read -r x z <place
jq --argjson x "$x" --argjson z "$z" '.bodies += [{name: "rod", link: -1, shape: "capsule", from: [$x, 0, $z - 40], to: [$x, 0, $z], radius: 0.5}]' \
    "$SAMPLES/robots/irb1400.json" >rod.json
status=0
fettle-collide rod.json two.pcd --report r.json -o /dev/null || status=$?
test $status -eq 1
jq -e '.collisions == 0 and .collisions_between == 1 and .min_between.pose == 1 and (.min_between.pair | index("rod") != null)' r.json >/dev/null
fettle-collide "$SAMPLES/robots/irb1400.json" two.pcd --report r.json -o /dev/null
jq -e '.collisions_between == 0 and .checked == 2' r.json >/dev/null

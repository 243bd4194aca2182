# A part in the robot's hand: a block whose face is before a fixed wheel stands off it by what the path says, to the micrometre, and lies 3 mm
# deep in it where the path says so, which is a collision; nothing else is near. References: the block, the wheel's cylinder, by hand.
# A robot with a table holds nothing, and what is held is not led around.
robot=$SAMPLES/robots/irb1400_belt.json
printf 'OFF\n8 6 0\n-10 -10 0\n10 -10 0\n10 10 0\n-10 10 0\n-10 -10 40\n10 -10 40\n10 10 40\n-10 10 40\n' >block.off
printf '4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n' >>block.off
path() { # height over the face y = 10, …
    printf '# units mm\nVERSION .7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 8 8 8 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH %d\nHEIGHT 1\nPOINTS %d\nDATA ascii\n' $# $#
    for height; do echo "0 $(awk -v h="$height" 'BEGIN { print 10 + h }') 30 0 0 0.70710678118654757 0.70710678118654757"; done
}
held() { path "$@" | fettle-path - --held part --wheel 900,1000,900,0,0,1,0; }
collide() { fettle-collide "$robot" --workpiece block.off --held --report report.json --ascii "$@"; }
held 12.5 5 0.25 | collide >clear.pcd
awk '$1 == "FIELDS" { for (k = 2; k <= NF; ++k) if ($k == "clearance") at = k - 1 } data { print $at } $1 == "DATA" { data = 1 }' clear.pcd >clearances
printf '12.5\n5\n0.25\n' | paste clearances - | awk '($1 - $2) ^ 2 > 1e-6 { exit 1 } END { exit NR != 3 }'
jq -e '.reached == 3 and .collisions == 0 and .min.pair == ["wheel", "workpiece"]' report.json >ok
held 2 -3 | collide >deep.pcd && exit 1
jq -e '.collisions == 1 and (.min.clearance + 3 | fabs) < 1e-3 and .min.pair == ["wheel", "workpiece"]' report.json >ok
held 5 >path.pcd
"$HERE/../refuses" '--held: goes with --workpiece' fettle-collide "$robot" path.pcd --held
"$HERE/../refuses" "path.pcd: is of a part in the robot's hand (field way): --held checks it there" fettle-collide "$robot" path.pcd --workpiece block.off
"$HERE/../refuses" '--held: goes with --workpiece' fettle-collide "$robot" path.pcd --workpiece block.off --held --avoid
"$HERE/../refuses" '--held: a robot with a table' fettle-collide "$SAMPLES/robots/irb1400_table.json" path.pcd --workpiece block.off --held

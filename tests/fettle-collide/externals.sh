# Where track and table are free to choose, collisions of the arm choose them. Reference: a wall on the table between the robot and the poses,
# which it stands in the way of as the table lies, and not behind them.
jq '.bodies += [{name: "wall", link: 8, shape: "box", at: {position: [820, 1000, 650]}, size: [20, 500, 500]}]' "$SAMPLES/robots/irb1400_table.json" >wall.json
awk 'BEGIN {
    print "VERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 8 8 8 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH 21\nHEIGHT 1\nPOINTS 21\nDATA ascii"
    for (i = 0; i <= 20; i++) print 1000, 990 + i, 500, 0, 0, 0, 1
}' >path.pcd
collide() { fettle-collide wall.json path.pcd --report r.json -q -o "$1" "${@:2}" || test $? -eq 1; }
collide fixed.pcd --track 1000 --table 0
jq -e '.collisions == 21 and .reached == 21' r.json >ok
collide turned.pcd --track 1000
jq -e '.collisions == 0 and .collisions_between == 0 and .reached == 21' r.json >ok
collide both.pcd
jq -e '.collisions == 0 and .collisions_between == 0 and .reached == 21' r.json >ok
collide one.pcd --threads 1
cmp both.pcd one.pcd

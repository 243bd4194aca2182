# Bodies of triangles, convex or not. A ball-end tool in a channel: its holder is 8 mm beside and 6 mm above the edge of a wall, 10 mm from it,
# by hand; the channel's hull holds the tool. Then a real arm, of ROS-Industrial's meshes: a hull is never farther than what it is the hull of.
refuses() { "$HERE/../refuses" "$@" </dev/null; }
cp "$SAMPLES/robots/irb1400.json" robot.json
awk 'BEGIN {
    # The profile across y, from the outside at the lower left on, and its two ends.
    split("-30 550 30 550 30 640 20 640 20 560 -20 560 -20 640 -30 640", p)
    print "OFF\n16 28 0"
    for (y = 950; y <= 1050; y += 100) for (i = 1; i <= 16; i += 2) print 1000 + p[i], y, p[i + 1]
    for (i = 0; i < 8; i++) { j = (i + 1) % 8; print 3, i, i + 8, j; print 3, j, i + 8, j + 8 }
    split("0 1 5 1 4 5 1 2 4 2 3 4 0 5 7 5 6 7", e)
    for (i = 1; i <= 18; i += 3) { print 3, e[i], e[i + 1], e[i + 2]; print 3, e[i] + 8, e[i + 2] + 8, e[i + 1] + 8 }
}' >channel.off
printf 'VERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 8 8 8 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1000 1000 600 0 0 0 1\n' >pose.pcd
for shape in mesh hull; do
    jq --arg shape $shape '.bodies += [{name: "channel", link: -1, shape: $shape, file: "channel.off"}]' robot.json >$shape.json
done
fettle-collide mesh.json pose.pcd --report mesh_found.json -o /dev/null 2>warnings
test ! -s warnings
jq -e '.min.pair == ["holder", "channel"] and (.min.clearance - 10 | fabs) < 1e-4' mesh_found.json >ok
fettle-collide hull.json pose.pcd --report hull_found.json -q -o /dev/null || test $? -eq 1
jq -e '.collisions == 1' hull_found.json >ok
# The channel on the tool and the pillar that it surrounds in the cell: mesh against mesh, 20 mm to each wall less half of the pillar.
jq '.bodies = [{name: "channel", link: 7, shape: "mesh", file: "channel.off", at: {position: [-1000, -1000, -600]}},
               {name: "pillar", link: -1, shape: "mesh", file: "pillar.off"}] | .allowed = []' robot.json >both.json
awk 'BEGIN {
    print "OFF\n8 12 0"
    for (i = 0; i < 8; i++) print 1000 + (i % 2 ? 12 : -12), 1000 + (int(i / 2) % 2 ? 9 : -9), (i > 3 ? 900 : 570)
    split("0 2 3 0 3 1 4 5 7 4 7 6 0 1 5 0 5 4 2 6 7 2 7 3 0 4 6 0 6 2 1 3 7 1 7 5", f)
    for (i = 1; i <= 36; i += 3) print 3, f[i], f[i + 1], f[i + 2]
}' >pillar.off
fettle-collide both.json pose.pcd --report both_found.json -q -o /dev/null
jq -e '(.min.clearance - 8 | fabs) < 1e-4' both_found.json >ok
fettle-collide both.json pose.pcd --workpiece pillar.off --report both_found.json -q -o /dev/null
jq -e '(.min.clearance - 8 | fabs) < 1e-4' both_found.json >ok
# An arm at forty configurations: reached by hulls no later, and by meshes exactly where they cross.
ur5=$SAMPLES/robots/ur5
awk 'BEGIN {
    srand(7)
    print "VERSION 0.7\nFIELDS joint1 joint2 joint3 joint4 joint5 joint6\nSIZE 8 8 8 8 8 8\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\nWIDTH 40\nHEIGHT 1\nPOINTS 40\nDATA ascii"
    for (i = 0; i < 40; i++) print 0, -180 + 4.5 * i, 150 - i, -90 + 9 * i, 60, 0
}' >joints.pcd
for meshes in exact hull; do
    fettle-collide "$ur5/ur5.urdf" joints.pcd --srdf "$ur5/ur5.srdf" --link-meshes $meshes --jump 90 --report $meshes.json -q --ascii -o $meshes.pcd || test $? -eq 1
    awk '/^FIELDS/ { for (i = 2; i <= NF; i++) if ($i == "clearance") column = i - 1 } data { print $column } /^DATA/ { data = 1 }' $meshes.pcd >$meshes.txt
done
paste exact.txt hull.txt | awk '$2 > $1 + 1e-3 && $1 > 0 { print; exit 1 } $1 > 1 && $2 < 0 { freed++ } $1 < 0 { crossing++ } END { if (!freed || !crossing) exit 1 }'
# What cannot be read.
sed '1,/upperarm.stl/ s/upperarm.stl"/upperarm.stl" scale="1 0 1"/' "$ur5/ur5.urdf" >flat.urdf
cp "$ur5"/*.stl .
refuses "the scale of its mesh is 0" fettle-collide flat.urdf joints.pcd
rm upperarm.stl
cp "$ur5/ur5.urdf" .
refuses 'there is no mesh upperarm.stl' fettle-collide ur5.urdf joints.pcd
refuses '--link-meshes' fettle-collide robot.json pose.pcd --link-meshes hull
refuses "--link-meshes: 'exakt' is none of exact, hull" fettle-collide "$ur5/ur5.urdf" joints.pcd --link-meshes exakt
jq '.bodies += [{name: "gone", link: -1, shape: "mesh", file: "gone.off"}]' robot.json >gone.json
refuses 'gone.off' fettle-collide gone.json pose.pcd
sed 's/^OFF/OFF/; s/^8 12 0/8 10 0/' pillar.off | sed '$d' | sed '$d' >open.off
jq '.bodies += [{name: "open", link: -1, shape: "mesh", file: "open.off"}]' robot.json >open.json
fettle-collide open.json pose.pcd -o /dev/null 2>warnings || test $? -eq 1
grep -q "the mesh of 'open' is not closed" warnings

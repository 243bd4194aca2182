# A robot as URDF: joints to poses and back, by all branches; collision shapes as bodies, pairs of an SRDF; what cannot be read is refused by
# name. Reference: the joints themselves; the zero pose of the UR5, by hand from its lengths.
refuses() { "$HERE/../refuses" "$@" </dev/null; }
urdf=$SAMPLES/robots/urdf
joints() { # J1 … J6
    printf 'VERSION 0.7\nFIELDS joint1 joint2 joint3 joint4 joint5 joint6\nSIZE 8 8 8 8 8 8\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n%s\n' "$*"
}
joints 0 0 0 0 0 0 | fettle-arm "$urdf/ur5.urdf" --forward --ascii |
    awk 'data { if (($1 + 817.25) ^ 2 + ($2 + 191.45) ^ 2 + ($3 + 5.491) ^ 2 > 1e-6) { print; exit 1 } } $1 == "DATA" { data = 1 }'
for robot in ur5 fanuc_m10ia staubli_rx160; do
    joints 10 -20 30 -40 50 -60 | fettle-arm "$urdf/$robot.urdf" --forward -o pose.pcd
    fettle-arm "$urdf/$robot.urdf" --inverse pose.pcd --start 10,-20,30,-40,50,-60 -o back.pcd
    fettle-arm "$urdf/$robot.urdf" --inverse pose.pcd --all --report all.json -o all.pcd
    fettle-diff --tol 1e-3 back.pcd <(fettle-arm "$urdf/$robot.urdf" --forward back.pcd) >difference
done
sed 's|<link name="forearm_link"/>|<link name="forearm_link"><collision><origin xyz="-0.2 0 0" rpy="0 1.5707963267948966 0"/><geometry><cylinder radius="0.05" length="0.3"/></geometry></collision></link>|
     s|<link name="base_link"/>|<link name="base_link"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>|' "$urdf/ur5.urdf" >bodies.urdf
joints 0 -90 150 0 0 0 >folded.pcd
fettle-collide bodies.urdf folded.pcd --beyond 2000 --report near.json -q -o /dev/null || test $? = 1
jq -e '.min.pair == ["base_link", "forearm_link"]' near.json >ok
printf '<robot name="ur5"><disable_collisions link1="forearm_link" link2="base_link" reason="User"/></robot>\n' >ur5.srdf
fettle-collide bodies.urdf folded.pcd --srdf ur5.srdf --beyond 2000 --report near.json -q -o /dev/null
jq -e '.min.pair == null' near.json >ok
refuses 'is a xacro file' fettle-arm <(echo '<robot xmlns:xacro="x"><xacro:include filename="a"/></robot>') --forward folded.pcd
refuses '--package: expected NAME=DIR' fettle-arm "$urdf/ur5.urdf" --package ur --forward folded.pcd
refuses '--package, --srdf, --tip and --link-meshes go with a URDF' fettle-arm "$SAMPLES/robots/irb2400.json" --tip tool0 --forward folded.pcd
sed 's|<link name="forearm_link"/>|<link name="forearm_link"><collision><geometry><mesh filename="package://ur/f.stl"/></geometry></collision></link>|' "$urdf/ur5.urdf" >mesh.urdf
refuses '--package ur=DIR says it' fettle-arm mesh.urdf --forward folded.pcd
refuses 'there is no mesh ./f.stl' fettle-arm mesh.urdf --package ur=. --forward folded.pcd
printf '<robot><disable_collisions link1="a"/></robot>\n' >half.srdf
refuses 'disable_collisions needs link1 and link2' fettle-arm "$urdf/ur5.urdf" --srdf half.srdf --forward folded.pcd
printf '<robot>\n<disable_collisions :link1="a" link2="b"/>\n</robot>\n' >colon.srdf # XML, but its reader wants a letter
refuses 'colon.srdf: line 2: ' fettle-arm "$urdf/ur5.urdf" --srdf colon.srdf --forward folded.pcd
# What liburdfdom leaves out or decides by names is refused: a shape that it does not know, half a scale, a collision without a shape, a link
# with two parents. A mesh in mm is 1000 times too large.
shape() { sed "s|<link name=\"forearm_link\"/>|<link name=\"forearm_link\"><collision>$1</collision></link>|" "$urdf/ur5.urdf" >shape.urdf; }
shape '<geometry><capsule radius="1" length="1"/></geometry>'
refuses 'shape.urdf: ' fettle-arm shape.urdf --forward folded.pcd
shape '<geometry><mesh filename="f.stl" scale="0.5"/></geometry>'
refuses 'shape.urdf: ' fettle-arm shape.urdf --forward folded.pcd
shape ''
refuses 'shape.urdf: ' fettle-arm shape.urdf --forward folded.pcd
sed 's|</robot>|<joint name="aa" type="fixed"><parent link="base_link"/><child link="tool0"/></joint></robot>|' "$urdf/ur5.urdf" >two.urdf
refuses "link 'tool0' hangs on two joints, 'aa' and 'flange-tool0'" fettle-arm two.urdf --forward folded.pcd
printf 'solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 90 0 0\nvertex 0 80 0\nendloop\nendfacet\nendsolid\n' >f.stl
shape '<geometry><mesh filename="f.stl"/></geometry>'
fettle-arm shape.urdf --forward folded.pcd -o /dev/null 2>said
grep -q "link 'forearm_link': its mesh is 120.4.* m long: is it in mm" said

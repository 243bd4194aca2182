# Programs for robots of URDFs in the frames of their controllers: world frame the link base, tools counted from the link tool0. KUKA's joint
# 1 turns about an axis that points down, Universal Robots are built in turned, Fanuc's frame lies at axis 2. Reference: a reader of
# the URDF and of the languages of its own.
refuses() { "$HERE/../refuses" "$@" </dev/null; }
urdf=$SAMPLES/robots/urdf
printf '%s\n' '10 -80 85 20 30 40' '12 -75 80 25 35 30' '-15 -65 95 -20 -40 70' '5 -95 105 40 60 -80' >bent
printf '%s\n' '10 15 0 20 30 40' '12 20 -5 25 35 30' '-15 30 -10 -20 -40 70' '5 5 10 40 60 -80' >upright
# LANGUAGE OPTION SUFFIX ROBOT JOINTS OPTION...
flange() {
    { printf 'VERSION 0.7\nFIELDS joint1 joint2 joint3 joint4 joint5 joint6\nSIZE 8 8 8 8 8 8\nTYPE F F F F F F\nCOUNT 1 1 1 1 1 1\n'
      printf 'WIDTH 4\nHEIGHT 1\nPOINTS 4\nDATA ascii\n'; cat "$5"; } >joints.pcd
    fettle-arm "$4" --forward joints.pcd --jump 200 --turn-feed 5 --feed 50 --unchecked "--$2" "p.$3" -q -o /dev/null "${@:6}"
    local files=p.$3
    [ "$3" != ls ] || files=p.ls,P_1.ls
    python3 "$HERE/flange-check.py" "$1" $files "$4" "$5"
}
flange krl krl src "$urdf/kuka_kr16_2.urdf" bent
flange krl krl src "$urdf/kuka_kr120r2500pro.urdf" bent
flange rapid rapid mod "$urdf/abb_irb6640.urdf" upright --coupling serial
flange ls ls ls "$urdf/fanuc_m10ia.urdf" upright
flange ls ls ls "$urdf/fanuc_lrmate200id.urdf" upright
flange urscript urscript script "$urdf/ur5.urdf" bent
flange urscript urscript script "$urdf/ur10e.urdf" bent
# a tool 120 mm long, on the flange, bent by 30 degrees, of a robot that stands turned on a pedestal
sed 's|</robot>|<link name="cell"/><link name="tip"/><joint name="a" type="fixed"><origin xyz="1 -0.5 0.8" rpy="0 0 0.7"/><parent link="cell"/><child link="base_link"/></joint><joint name="b" type="fixed"><origin xyz="0.02 0 0.12" rpy="0 0.5235987755982988 0"/><parent link="tool0"/><child link="tip"/></joint></robot>|' "$urdf/kuka_kr16_2.urdf" >stand.urdf
flange krl krl src stand.urdf bent --tip tip
grep -qF '$TOOL={X 20,Y 0,Z 120,A 0,B 30,C 0}' p.src
# ABB's controllers count joint 3 of an arm with a parallelogram from the horizontal, which a URDF cannot say
flange rapid rapid mod "$urdf/abb_irb2400.urdf" upright --coupling parallelogram
grep -qF 'jointtarget begin1 := [[10,15,15,20,30,40]' p.mod
refuses '--rapid of a URDF needs --coupling serial or parallelogram' fettle-arm "$urdf/abb_irb2400.urdf" --forward joints.pcd --jump 200 --turn-feed 5 --feed 50 --unchecked --rapid q.mod
refuses '--coupling goes with a URDF: a robot file says it' fettle-arm "$SAMPLES/robots/irb2400.json" --forward joints.pcd --jump 200 --turn-feed 5 --feed 50 --unchecked --coupling serial --krl q.src
# frames that nobody told
refuses 'no program can be written: no link is called base' fettle-arm "$urdf/kuka_kr210l150.urdf" --forward joints.pcd --jump 200 --turn-feed 5 --feed 50 --unchecked --krl q.src
sed 's/"tool0"/"flange0"/' "$urdf/ur5.urdf" >flange0.urdf
refuses 'no program can be written: no link is called tool0' fettle-arm flange0.urdf --forward joints.pcd --jump 200 --turn-feed 5 --feed 50 --unchecked --urscript q.script
sed '/"base_link-base"/,/<.joint>/s/0 0 0.450/0 0 0/' "$urdf/fanuc_m10ia.urdf" >low.urdf
refuses 'axis 2 is 450 mm over the link base' fettle-arm low.urdf --forward joints.pcd --jump 200 --turn-feed 5 --feed 50 --unchecked --ls q.ls
test ! -e q.mod -a ! -e q.src -a ! -e q.script -a ! -e q.ls

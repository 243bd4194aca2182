# A part in the robot's hand, a wheel on a stand: a contact point 100 mm along x of the part's frame, under a wheel at
# (1500, 0, 1100), puts that frame at (1400, 0, 1100); fettle-arm finds the joints, and --forward leads back to the same poses. A
# wheel out of reach shows as poses that are not reached. Reference: by hand; the robot's kinematics both ways.
{
    printf '# units mm\nVERSION .7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 8 8 8 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n'
    printf 'WIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ascii\n100 0 0 1 0 0 0\n100 5 0 1 0 0 0\n100 10 0 1 0 0 0\n'
} > path.pcd
fettle-path path.pcd --held part --wheel 1500,0,1100,1,0,0,0 --ascii > held.pcd
awk 'data { if (($1 - 1400) ^ 2 + ($2 + 5 * n) ^ 2 + ($3 - 1100) ^ 2 > 1e-6 || $4 ^ 2 + ($5 ^ 2 - 1) ^ 2 > 1e-12) exit 1; ++n } $1 == "DATA" { data = 1 }' held.pcd
# the wheel above turned so that its contact frame points down: the part hangs under the flange
fettle-path path.pcd --held part --wheel 1100,0,700,0,1,0,0 > hung.pcd
fettle-arm "$SAMPLES/robots/irb1400.json" --inverse hung.pcd > joints.pcd
fettle-arm "$SAMPLES/robots/irb1400.json" --forward joints.pcd | fettle-diff --tol 1e-3 - <(fettle-arm "$SAMPLES/robots/irb1400.json" --inverse hung.pcd)
status=0
fettle-path path.pcd --held part --wheel 9000,0,1100,1,0,0,0 | fettle-arm "$SAMPLES/robots/irb1400.json" --inverse - --report arm.json > far.pcd || status=$?
test $status = 1
jq -e '.unreachable == 3' arm.json > ok
# The feed is the contact's along the part: a cylinder of 20 mm turns by 60 degrees about its own axis, where the part's frame is, or beside it.
# Reference: an arc of 20.944 mm at 10 mm/s takes 2.0944 s; where the frame rests, a program cannot say so.
arc() { # X: of the axis in the part's frame
    printf '# units mm\nVERSION .7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 8 8 8 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH 61\nHEIGHT 1\nPOINTS 61\nDATA ascii\n'
    # +z of the contact along (cos a, sin a, 0)
    awk -v x="$1" 'BEGIN { r = atan2(1, 1) / 45; for (a = 0; a <= 60; ++a) { c = cos(a * r / 2); s = sin(a * r / 2)
        print x + 20 * cos(a * r), 20 * sin(a * r), 200, c, -s, c, s } }'
}
run() { fettle-arm "$SAMPLES/robots/irb1400_belt.json" --inverse "$1" --feed 10 --jump 180 "${@:2}"; }
for x in 0 60; do
    arc $x | fettle-path - --held part --wheel 900,1000,900,0,0,1,0 -o arc$x.pcd
    run arc$x.pcd --report arc.json -q -o /dev/null
    jq -e '.reached == 61 and (.time - 20 * 3.14159265 / 3 / 10 | fabs) < 1e-3' arc.json >ok || { jq -c '[.reached, .time]' arc.json; exit 1; }
done
"$HERE/../refuses" 'pose 1: the contact moves 0.349' fettle-arm "$SAMPLES/robots/irb1400_belt.json" --inverse arc0.pcd --feed 10 --jump 180 --unchecked --rapid arc.mod
# 60 mm from the axis each degree is a way of 1.047 mm of the frame, for 0.349 of the contact
run arc60.pcd --unchecked --rapid arc.mod -q -o /dev/null
grep -c 'MoveL p[0-9]*, v_\(29_99\|30_00\|30\)' arc.mod | grep -qx 60

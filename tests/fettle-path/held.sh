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

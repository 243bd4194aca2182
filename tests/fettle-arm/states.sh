# Unreachable poses are reported one by one, and the answer is no. Reference: the arm's length, and its ranges.
header() { # POINTS
    printf 'VERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH %s\nHEIGHT 1\nPOINTS %s\nDATA ascii\n' "$1" "$1"
}
# upright above the bench; 5 m away; no pose; the tool from below, which joint 5 does not reach here
{ header 4; printf '1000 1000 500 1 0 0 0\n5000 1000 500 1 0 0 0\nnan 0 0 1 0 0 0\n1000 1000 500 0 1 0 0\n'; } >path.pcd
status=0
fettle-arm "$SAMPLES/robots/irb1400.json" --inverse path.pcd --track 1000 --report r.json --rapid out.mod --feed 10 --ascii >joints.pcd 2>err || status=$?
test $status -eq 1
jq -e '.count == 4 and .reached == 1 and .unreachable == 1 and .undefined == 1 and .out_of_range == 1 and ([.joints[].out_of_range] | add) == 1' r.json >/dev/null
grep -q 'the robot cannot run this path: pose 1: is out of the arm.s reach: the flange would be [0-9.]* mm from the base; out.mod is not written' err
test ! -e out.mod
awk '$1 == "FIELDS" { for (k = 2; k <= NF; k++) if ($k == "state") s = k - 1 } data { print $s } $1 == "DATA" { data = 1 }' joints.pcd | diff - <(printf '0\n1\n3\n2\n')
# every solution of the first pose brings the tool there
fettle-arm "$SAMPLES/robots/irb1400.json" --inverse path.pcd --track 1000 --all -q -o all.pcd || test $? -eq 1
fettle-arm "$SAMPLES/robots/irb1400.json" --forward all.pcd --jump 1000 --ascii | awk '
    data { n++; if (($1 - 1000)^2 + ($2 - 1000)^2 + ($3 - 500)^2 > 1e-6) exit 1 } $1 == "DATA" { data = 1 } END { exit !(n >= 2) }'
# a joint that would be too fast: the IRB 2400 turns joint 6 at 450 degrees a second at most. The time of a turn is the tool's.
{ header 2; printf '900 0 700 1 0 0 0\n900 0 700 0.9990482 0 0 0.0436194\n'; } >turn.pcd # by 5 degrees
fettle-arm "$SAMPLES/robots/irb2400.json" --inverse turn.pcd --feed 10 --turn-feed 400 --report slow.json -o /dev/null
status=0
fettle-arm "$SAMPLES/robots/irb2400.json" --inverse turn.pcd --feed 10 --turn-feed 900 --report fast.json -o /dev/null || status=$?
test $status -eq 1
jq -e '([.joints[].too_fast] | add) == 0 and .joints[5].max_speed > 300' slow.json >/dev/null
jq -e '.joints[5].too_fast == 1 and .joints[5].max_speed > 450' fast.json >/dev/null
jq -es '(.[1].joints[5].max_speed / .[0].joints[5].max_speed - 900 / 400 | fabs) < 1e-9' slow.json fast.json >/dev/null
# Why a path cannot be run: the first pose in the way, with its joint. Reference: the poses themselves.
why() { # REASON PATH OPTION...
    local status=0
    fettle-arm "$SAMPLES/robots/irb1400.json" --inverse "$2" --feed 10 --rapid why.mod -o why.pcd "${@:3}" 2>why || status=$?
    test $status -eq 1
    grep -q "cannot run this path: $1; why.mod is not written" why || { cat why; exit 1; }
}
{ header 2; printf '1000 1000 500 1 0 0 0\n1000 1000 500 0 1 0 0\n'; } >below.pcd
why 'pose 1: joint 5 would be at [-0-9.]* degrees, out of its range of -115 to 115' below.pcd --track 1000
why 'pose 0: joint 7 would be at 3000 mm, out of its range of 0 to 2000' below.pcd --track 3000
{ header 2; printf '1000 1000 500 1 0 0 0\nnan 0 0 1 0 0 0\n'; } >undefined.pcd
why 'pose 1: is not defined' undefined.pcd --track 1000
{ header 2; printf '1000 1000 500 1 0 0 0\n1000 1000 500 0.7071 0 0 0.7071\n'; } >quarter.pcd
why 'pose 1: joint [46] jumps by [0-9.]* degrees, from [-0-9.]* to [-0-9.]*' quarter.pcd --track 1000
jq '.dh[5].max_speed_deg = 1' "$SAMPLES/robots/irb1400.json" >slow.json
{ header 2; printf '1000 1000 500 1 0 0 0\n1000 1000 500 0.9990482 0 0 0.0436194\n'; } >little.pcd
fettle-arm slow.json --inverse little.pcd --track 1000 --feed 10 --turn-feed 400 --rapid why.mod -o why.pcd 2>why || [ $? = 1 ]
grep -q 'pose 1: joint 6 is too fast on the way to it: [0-9.]* degrees/s' why

# A conversation by hand: before its frame the robot knows no place and does not move; a frame is a pose and comes once; then it goes where it reaches, and
# says of what it does not reach the place, the joint and its value, without having moved. References: the protocol; the frame and the robot's file.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 0.01
talk() { fettle-gantry-robot "$ROBOT" plan.json --stock stock.stl --cell 0.2 "$@"; }
answers=$(talk --moves moves.csv << END
1 connect fettle-gantry 1
2 home 0
3 travel 0 0 10
4 frame 1000 1000 650 1 0 0
5 frame 1000 1000 650 1 1 0 0
6 frame 1000 1000 650 1 0 0 nan
7 frame 1000 1000 650 0.9659258262890683 0.25881904510252074 0 0
8 frame 1000 1000 650 1 0 0 0
9 limit 15
10 home 0
11 travel -5 -5 4.9
12 move -5 -4 4.9 20
13 move -5 900 4.9 20
14 travel 0 0 2000
15 status
16 press 0 0 5 20 5
17 home 0.1
18 move 0 0 4.9 251
19 touch_off
20 probe 0.5 -0.5 2
21 lift 12
22 quit
END
)
awk 'NR == 1 && !(NF == 12 && $2 " " $3 " " $4 == "ok fettle-gantry 1" && $11 == 250) { exit 1 }
    (NR == 2 || NR == 3) && !/error the robot does not know where the job lies: no frame was given/ { exit 1 }
    NR == 4 && !/error makes no sense: .1000 1000 650 1 0 0.$/ { exit 1 }
    NR == 5 && !/error turns by a quaternion of length 1.414/ { exit 1 }
    NR == 6 && !/error says nan/ { exit 1 }
    (NR == 7 || NR == 10) && !(NF == 9 && $2 == "ok" && $4 ^ 2 + $5 ^ 2 < 1e-20 && $6 == 20) { exit 1 }
    NR == 8 && $0 != "8 error the frame of the job is set once" { exit 1 }
    (NR == 11 || NR == 12) && !(NF == 9 && $6 > 4.89 && $6 < 4.91 && $8 > 0.05) { exit 1 }
    NR == 13 && !/error the pose at -5 .* 4.9 mm(: joint [1-6] would be at .* degrees, out of its range of .* to | is out of the arm.s reach: the flange would be .* mm from the base)/ { exit 1 }
    NR == 14 && !/error the pose at 0 0 .* mm is out of the arm.s reach/ { exit 1 }
    NR == 15 && !($4 == -5 && $5 == -4 && $6 == 4.9) { exit 1 }
    NR == 16 && !/error the machine cannot hold a force/ { exit 1 }
    NR == 17 && !/error the head stands at 0 rad/ { exit 1 }
    NR == 18 && !/error no feed of 251/ { exit 1 }
    NR == 19 && !(NF == 10 && $3 > 9.99 && $3 < 10.01) { exit 1 }
    NR == 20 && !(NF == 10 && $3 > 5 && $3 < 5.02 && $7 > 19.99) { exit 1 }
    NR > 20 && !($2 == "ok" && NF == 9) { exit 1 }
    $1 != NR { exit 1 }
    END { exit NR != 22 }' <<< "$answers" || { echo "$answers"; exit 1; }
# Nothing of what was refused is among the moves; in the part's frame they go no higher than the safe height.
awk -F , 'NR > 1 && !($1 > 990 && $1 < 1010) { exit 1 } END { exit NR < 60 }' moves.csv

# `halt` ends what is under way; the next command works.
answers=$(printf '1 frame 1000 1000 650 1 0 0 0\n2 travel -5 -5 4.9\n3 halt\n4 travel 5 5 10\n' | talk)
awk 'NR == 2 && $0 != "2 error stopped by the operator" { exit 1 } NR == 3 && $2 != "ok" { exit 1 } NR == 4 && !($4 == 5 && $6 == 10) { exit 1 } END { exit NR != 4 }' <<< "$answers" || { echo "$answers"; exit 1; }

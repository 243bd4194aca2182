# A conversation by hand, line by line: the limits of the machine, a move down on a flat part, a step, an unknown command, a touch
# on the hill of 0.01 mm and one that meets nothing, and the end. References: the protocol; the part's height, 5 mm.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
make_stock 0.01
answers=$(fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2 --machine "$SAMPLES/machines/full_scale.json" --ground ground.pcd << END
1 connect fettle-gantry 1
2 limit 15
3 home 0
4 travel -5 -5 4.9
5 move -5 -4 4.9 20
6 dance
7 lift 8
8 touch_off
9 probe 0.5 -0.5 2
10 probe 0 0 8
11 home 0.1
12 change_wheel
13 quit
END
)
awk 'NR == 1 && !($1 == 1 && $2 == "ok" && $3 " " $4 == "fettle-gantry 1" && NF == 12 && $5 < $6) { exit 1 }
    NR == 2 && $0 != "2 ok 15" { exit 1 }
    (NR == 4 || NR == 5) && !(NF == 9 && $6 > 4.89 && $6 < 4.91 && $8 > 0.1 && $8 <= $9) { exit 1 }
    NR == 5 && !(($5 + 4) ^ 2 < 0.01) { exit 1 }
    NR == 6 && $0 != "6 error no such command: dance" { exit 1 }
    NR == 7 && !($6 > 7.99 && $6 < 8.01 && $8 < 0.5 && $9 > 0.7) { exit 1 }
    NR == 8 && !(NF == 10 && $3 > 9.99 && $3 < 10.01) { exit 1 }
    NR == 9 && !(NF == 10 && $3 > 5.009 && $3 < 5.011 && $7 > 19.99) { exit 1 }
    NR == 10 && $3 != "none" { exit 1 }
    NR == 11 && $0 != "11 error the head stands at 0 rad" { exit 1 }
    NR == 12 && !(NF == 9 && $2 == "ok" && $3 > t && $4 == x && $5 == y && $6 > 19.99) { exit 1 }
    NR == 10 { t = $4; x = $5; y = $6 }
    $1 != NR { exit 1 }
    END { exit NR != 13 }' <<< "$answers"
grep -q '^FIELDS x y z' <(head -c 500 ground.pcd)

# Invalid requests: positions and feeds outside the machine's range, each refused without ending.
refused=0
while read -r command; do
    answers=$(printf '1 %s\n2 status\n' "$command" | fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2)
    grep -q '^1 error .*\(reach\|feed\)' <<< "$answers" && [ "$(wc -l <<< "$answers")" = 2 ] || { echo "$command: $answers"; exit 1; }
    refused=$((refused + 1))
done << END
move 1e9 0 10 10
travel 1e300 0 0
lift -1e300
probe 1e300 0 0
move 0 0 10 0
move 0 0 10 1e-310
move 0 0 10 -5
press 0 0 10 1e300 20
END
[ $refused = 8 ]
[ "$(fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2 <<< '1 press -5 -5 10 20 5')" = '1 error the machine cannot hold a force' ]

# A client that has ended: the driver ends by itself.
fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2 <<< '1 status' > out
[ "$(wc -l < out)" = 1 ]

# Far below the part the wheel is worn away; when the client has ended, the part is kept all the same.
answers=$(printf '1 travel 0 0 5\n2 move 5 5 -9000 10000\n' | fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2 --ground worn.pcd)
grep -q '^2 error .*the wheel is worn away' <<< "$answers"
grep -q '^FIELDS x y z' <(head -c 500 worn.pcd)

# A client that has ended before the answer: the same.
(sleep 0.5; echo '1 status') | fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2 --ground left.pcd | true
grep -q '^FIELDS x y z' <(head -c 500 left.pcd)

# The safety of the gantry holds on the robot: answers that cannot be true stop the run before the wheel has gone over a bump of 0.8 mm; a run that is killed at any
# moment goes on from its trace, on the robot that has kept its stock; a robot whose client has ended lifts. References: docs/driver.md; the plane; the undisturbed run.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 0.8
make_place 25
robot() { echo "fettle-gantry-robot $ROBOT $PWD/plan.json --stock $PWD/${1:-stock.stl} --cell 0.2"; }
grind() { fettle-grind plan.json --stock stock.stl --cell 0.2 --place place.txt --ascii "$@"; }
check() { # LIE MESSAGE
    status=0
    grind --report report.json --trace trace.pcd --gantry "exec:exec $HERE/../fettle-grind/lying-driver $1 $(robot)" > ground.pcd 2> message || status=$?
    [ $status = 1 ] && [ "$(wc -l < message)" = 1 ] && grep -q -- "$2" message || { echo "$1: status $status"; cat message; exit 1; }
    jq -e '.finished == false' report.json > ok && [ "$(tail -n 1 trace.pcd | cut -d ' ' -f 7)" = 12 ]
}
check dead 'no contact is reported at x '
check numb 'reports a force of 0 N at a deflection of '
check stuck 'reports a force of 9 N at a deflection of 0 mm'
check early 'stops 0.8 mm early after '

grind --trace whole.pcd --gantry "exec:$(robot)" > ground.pcd
rows() { awk '/^POINTS/ { n = $2 } body && n-- > 0 { sub(/ *$/, ""); print } /^DATA/ { body = 1 }' "$1"; }
for wait in 0.05 0.15 0.3; do
    rm -f left.pcd moves.pcd trace.pcd
    grind --trace trace.pcd --gantry "exec:exec $(robot) --ground left.pcd --moves moves.pcd" > ground.pcd &
    client=$!
    for _ in {1..200}; do [ -s trace.pcd ] && break || sleep 0.02; done
    sleep $wait
    kill -9 $client 2> killed || true
    wait $client 2> killed || true
    for _ in {1..100}; do [ -s moves.pcd ] && break || sleep 0.05; done
    # It has lifted: the last place is the safe height of 20 mm, 650 mm above the floor and tilted by 25 degrees.
    fettle-place moves.pcd --matrix place.txt --inverse back.txt -q -o there.csv 2> warning
    fettle-place moves.pcd --matrix back.txt -q -o job.csv 2> warning
    tail -n 1 job.csv | awk -F , '{ exit !($3 > 19.99 && $3 < 20.01) }'
    rows trace.pcd | awk '$7 != 13' > done
    rows whole.pcd | awk -v n="$(wc -l < done)" 'NR <= n' | cmp - done
    grind --resume trace.pcd --report report.json --gantry "exec:$(robot left.pcd)" > ground.pcd
    jq -e .finished report.json > ok
    rows ground.pcd | awk '$1 > -6 && $1 < 6 && $2 > -6 && $2 < 6 { if ($3 > 5.1 || $3 < 4.99) exit 1; ++n } END { exit n < 3000 }'
done

# What is no driver, or one of another machine, ends with status 2 and one line of fettle-grind before anything moves.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 1
jq ".job.force.max = 16 | .layers.thickness = 1.1 | .layers.distance = 0.6 | .layers.overlap_case = 2" plan.json > other.json
refused() { # WORDS COMMAND
    status=0
    fettle-grind plan.json --stock stock.stl --patience 1 --gantry "exec:$2" > out 2> message || status=$?
    [ $status = 2 ] && [ ! -s out ] && [ "$(grep -c '^fettle-grind: ' message)" = 1 ] && grep -q "$1" message || { echo "$2: $status"; cat message; exit 1; }
}
refused 'ended with status 127' 'no-such-program'
refused 'ended with status 3' 'exit 3'
refused 'makes no sense' 'echo hello; sleep 5'
refused 'speaks another protocol' 'echo 1 ok grbl 1.1; sleep 5'
refused 'no range or no speed' 'echo 1 ok fettle-gantry 1 -500 500 -500 500 -500 500 0 999; sleep 5'
refused 'no range or no speed' 'echo 1 ok fettle-gantry 1 500 -500 -500 500 -500 500 100 999; sleep 5'
refused 'without an end' 'head -c 100000 /dev/zero; sleep 5'
refused 'reports: F_max is' 'fettle-gantry-virtual other.json --stock stock.stl --cell 0.4'
jq '.axes.x.min = 1' "$SAMPLES/machines/full_scale.json" > machine.json
refused 'axes.x goes from' 'fettle-gantry-virtual plan.json --stock stock.stl --machine machine.json'
# A machine so slow that a way of it takes for ever: the first move is waited for until the driver ends.
slow='echo 1 ok fettle-gantry 1 -500 500 -500 500 -500 500 1e-320 999; echo 2 ok 15; echo 3 ok 0 0 0 30 0 0 0; for i in 1 2 3 4; do read -r command; done'
status=0
fettle-grind plan.json --stock stock.stl --patience 1 --gantry "exec:$slow" --report report.json > out 2> message || status=$?
[ $status = 1 ] && grep -q 'ended with status 0; stopped' message && jq -e '.finished == false' report.json > ok || { echo "$status"; cat message; exit 1; }

# A driver whose answers cannot be true, in nine ways: the run stops with one line that names the driver's fault, before the machine
# has gone over a bump of 0.8 mm that its dead transducer does not report. Reference: docs/driver.md. What is known of the stock
# decides whether a reading of 0 can be true: without the bump in it the same answers are those of a machine in the air.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 0.8
driver="fettle-gantry-virtual $PWD/plan.json --stock $PWD/stock.stl --cell 0.2"
check() { # STATUS LIE MESSAGE [OPTION…]
    local expected=$1 lie=$2 words=$3 status=0
    shift 3
    fettle-grind plan.json --stock stock.stl --cell 0.2 --report report.json --trace trace.pcd --ascii "$@" \
        --gantry "exec:exec $HERE/lying-driver $lie $driver" > ground.pcd 2> message || status=$?
    [ $status = "$expected" ] && [ "$(wc -l < message)" = 1 ] && grep -q -- "$words" message ||
        { echo "$lie: status $status"; cat message; exit 1; }
    [ "$expected" = 2 ] || { jq -e '.finished == false' report.json > ok && [ "$(tail -n 1 trace.pcd | cut -d ' ' -f 7)" = 12 ]; }
}
check 1 dead 'no contact is reported at x .*, at most 0 N were reported'
check 1 numb 'reports a force of 0 N at a deflection of .* mm, where the head.s spring has '
check 1 stuck 'reports a force of 9 N at a deflection of 0 mm, where the head.s spring has 0 N'
check 1 far 'reports a deflection of 1e+30 mm; the head travels 1000 mm'
check 1 strong 'reports a force of 1e+30 N; the head.s spring has at most 10000 N'
check 1 ahead 'jumps ahead in time by 1e+12 s'
check 1 wheel 'measures a wheel of 1e+06 mm; a new one has 10 mm'
check 1 early 'stops 0.8 mm early after .travel_low .*, but reported at most 0 N'
check 2 limit 'guards its moves at 1000 N instead of 15'

# The machine file says how well the head measures: there 0.05 mm of deflection without force are too much.
check 1 numb 'reports a force of 0 N at a deflection of 0.0' --machine "$SAMPLES/machines/full_scale.json"

# An honest driver goes through, and a plate without the bump tells nothing about a dead transducer.
fettle-grind plan.json --stock stock.stl --cell 0.2 --gantry "exec:exec $HERE/lying-driver none $driver" --report report.json > ground.pcd
jq -e .finished report.json > ok
jq '.anomalies = []' part.json | fettle-part > plate.stl
fettle-grind plan.json --stock plate.stl --cell 0.2 --gantry "exec:exec $HERE/lying-driver dead ${driver/stock.stl/plate.stl}" --report report.json > ground.pcd
jq -e .finished report.json > ok

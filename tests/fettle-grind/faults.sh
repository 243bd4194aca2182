# A driver at fault, in one of six ways, 20 times each at different answers: every time status 1, one line (with -q, too) that
# names the driver and the fault, a trace that ends in event 12 and holds what was done, a readable part, and no process left behind. From
# every trace the work goes on to its end, here on a simulated machine.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
driver="fettle-gantry-virtual $PWD/plan.json --stock $PWD/stock.stl --cell 0.4 --machine $SAMPLES/machines/full_scale.json"
fettle-grind plan.json --stock stock.stl --cell 0.4 --gantry virtual:dynamic --machine "$SAMPLES/machines/full_scale.json" --trace whole.pcd --ascii > whole-ground.pcd
check() { # FAULT N MESSAGE
    status=0
    fettle-grind plan.json --stock stock.stl --cell 0.4 --patience 1 --trace trace.pcd --ascii \
        -q --gantry "exec:exec $HERE/faulty-driver $1 $2 $driver" > ground.pcd 2> message || status=$?
    [ $status = 1 ] || { echo "$1 $2: status $status"; cat message; exit 1; }
    [ "$(wc -l < message)" = 1 ] && grep -q "faulty-driver $1 .*$3.*; stopped" message || { echo "$1 $2:"; cat message; exit 1; }
    [ "$(tail -n 1 trace.pcd | cut -d ' ' -f 7)" = 12 ]
    # what was done is the beginning of the whole
    sed '1,/^DATA/d' trace.pcd | sed '$d' > done
    sed '1,/^DATA/d' whole.pcd | awk -v n="$(wc -l < done)" 'NR <= n' | cmp - done
    grep -q '^DATA ascii' ground.pcd
    fettle-grind plan.json --stock stock.stl --cell 0.4 --resume trace.pcd --report report.json > ground.pcd
    jq -e .finished report.json > ok
}
# With FETTLE_DRAWS=few (make test) every seventh answer is tried.
every=1
[ "${FETTLE_DRAWS:-all}" = all ] || every=7
answers=(4 5 6 7 9 12 16 22 30 41 55 70 88 101 130 170 211 300 401 500)
for ((i = 0; i < 20; i += every)); do
    n=${answers[i]}
    check dies $n 'was killed by signal 9'
    check nonsense $n 'makes no sense'
    check repeats $n 'answers number'
    check nan $n 'says nan'
    check jumps $n '\(jumps by\|stands at\)'
done
for ((n = 5; n < 25; n += every)); do check hangs $n 'does not answer'; done # before the next touch-off, for which it would be waited longer
if pgrep -f "fettle-gantry-virtual $PWD/plan.json" > left; then cat left; exit 1; fi

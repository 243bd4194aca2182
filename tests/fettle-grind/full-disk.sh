# The disk of the trace is full in the middle of a run (a limit on the size of files does the same): the run stops with status 1
# and names the trace; the ground part and the report are written, the trace has what there was room for, and the run goes
# on from there. Reference: the undisturbed run, of which it is the beginning.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
fettle-grind plan.json --stock stock.stl --cell 0.4 --trace whole.pcd --ascii > ground.pcd
(
    export GCOV_PREFIX=/dev/null # what make coverage counts would be cut short, too
    ulimit -f 40
    fettle-grind plan.json --stock stock.stl --cell 0.4 --trace trace.pcd --report report.json --ascii 2> message || echo $? > status
) | cat > ground.pcd
[ "$(cat status)" = 1 ] && [ "$(wc -l < message)" = 1 ] && grep -q 'trace.pcd: cannot write: .*; stopped' message || { cat status message; exit 1; }
jq -e '.finished == false' report.json > ok
[ "$(wc -l < ground.pcd)" -gt 1000 ]
awk '/^POINTS/ { n = $2 } body && n-- > 0 && $7 != 13 { sub(/ *$/, ""); print } /^DATA/ { body = 1 }' trace.pcd > done
[ "$(wc -l < done)" -gt 50 ]
sed '1,/^DATA/d' whole.pcd | awk -v n="$(wc -l < done)" 'NR <= n' | cmp - done
fettle-grind plan.json --stock stock.stl --cell 0.4 --resume trace.pcd --report report.json 2> message > ground.pcd
jq -e .finished report.json > ok

# A bound is reached: status 1, a message with the state, and the ground part and the trace as far as they got.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
for bound in layers coverings re_cuts steps time; do
    status=0
    jq ".bounds.$bound = if \"$bound\" == \"re_cuts\" then 0 else 1 end" plan.json |
        fettle-grind --stock stock.stl --trace trace.pcd --ascii > ground.pcd 2> message || status=$?
    cat message >&2
    [ $status = 1 ]
    [ "$(tail -n 1 trace.pcd | cut -d ' ' -f 7)" = 9 ]
    [ "$(wc -l < ground.pcd)" -gt 10000 ]
done
# The layers end at the safe height, 20 mm; a bound below that is the plan's own. The machine's metal is higher than the stock that
# is known of it, which would be refused.
make_stock 30
mv stock.stl metal.stl
make_stock 4
driven=(--stock stock.stl --gantry "exec:fettle-gantry-virtual job.json --stock metal.stl")
status=0
fettle-grind plan.json "${driven[@]}" > ground.pcd 2> message || status=$?
cat message >&2
[ $status = 1 ]
grep -q 'limit reached: layers 31: the next one is above the safe height; in layer 31,' message
jq '.bounds.layers = 30' plan.json | fettle-grind "${driven[@]}" > ground.pcd 2> message || status=$?
grep -q 'limit reached: layers 30; in layer 30,' message

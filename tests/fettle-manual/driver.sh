# Through the drivers' protocol the same is done, byte for byte; the stick's lines come from a pipe. The drives go no lower than --lowest.
# Reference: the simulated machine itself, and the number given.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
make_stock 4
printf '0 -1 0 up\n0.1 0 1\n0.4 0 -1\n0.6 0 0\n5 1 0\n5.1 end\n' > steer.txt
machine="$SAMPLES/machines/full_scale.json"
fettle-manual job.json --stock stock.stl --cell 0.1 --machine "$machine" --steer steer.txt --lowest 4 --trace direct.pcd > direct-ground.pcd
fettle-manual job.json --stock stock.stl --cell 0.1 --lowest 4 --trace driven.pcd --steer - < <(cat steer.txt) \
    --gantry "exec:fettle-gantry-virtual plan.json --stock stock.stl --cell 0.1 --machine $machine" > driven-ground.pcd
cmp direct.pcd driven.pcd
# A machine that reports a fault: the run ends there with status 1, and its trace says so. Reference: the driver's words.
status=0
fettle-manual job.json --stock stock.stl --cell 0.1 --lowest 4 --trace fault.pcd --ascii --steer steer.txt --report fault.json 2>message >fault-ground.pcd \
    --gantry "exec:echo 1 ok fettle-gantry 1 -500 500 -500 500 -500 500 100 999; echo 2 ok 15; echo 3 ok 0 0 0 30 0 0 0; echo 4 error no air; sleep 1" || status=$?
[ $status = 1 ]
grep -q 'reports: no air' message
awk '/^FIELDS/ { for (i = 2; i <= NF; i++) if ($i == "event") event = i - 1 } /^DATA/ { body = 1; next } body { last = $event } END { exit last != 12 }' fault.pcd
fettle-manual job.json --stock stock.stl --cell 0.1 --machine "$machine" --steer steer.txt --lowest 7 --force 14 --trace high.pcd --ascii > ground.pcd
awk '/^DATA/ { body = 1; next } body && $9 > 0 { n++; if ($3 < 6.99) exit 1 } END { exit n < 50 }' high.pcd

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
fettle-manual job.json --stock stock.stl --cell 0.1 --machine "$machine" --steer steer.txt --lowest 7 --force 14 --trace high.pcd --ascii > ground.pcd
awk '/^DATA/ { body = 1; next } body && $9 > 0 { n++; if ($3 < 6.99) exit 1 } END { exit n < 50 }' high.pcd

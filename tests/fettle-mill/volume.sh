# What is removed is what the stock has lost, cell by cell, and a stock from a file is cut as the box that it is; a second
# run over the same path finds nothing. Reference: these identities.
fettle-mill "$SAMPLES/programs/pocket.nc" --stock box:0,0,-12,80,60,0 --cutter ball:6 --step 0.2 --report box.json --pcd --ascii > box.pcd
awk '/^DATA/ { body = 1; next } body { sum += $4 } END { printf "%.9g\n", sum * 0.04 }' box.pcd > sum
jq -e --slurpfile sum sum '(.removed_volume / $sum[0] - 1 | fabs) < 1e-6 and .removed_volume > 6000 and .rapid_volume == 0' box.json > ok
printf 'OFF\n8 6 0\n0 0 -12\n80 0 -12\n80 60 -12\n0 60 -12\n0 0 0\n80 0 0\n80 60 0\n0 60 0\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n' > box.off
fettle-mill "$SAMPLES/programs/pocket.nc" --stock box.off --cutter ball:6 --step 0.2 --report off.json --pcd --ascii > off.pcd
cmp box.pcd off.pcd
jq '.removed_volume' box.json | cmp - <(jq '.removed_volume' off.json)
cat "$SAMPLES/programs/pocket.nc" > twice.nc
sed -i '/^%/d; /M30/d' twice.nc
cat twice.nc twice.nc > again.nc
fettle-mill again.nc --stock box:0,0,-12,80,60,0 --cutter ball:6 --step 0.2 --report again.json > /dev/null
jq -e --slurpfile once box.json '(.removed_volume / $once[0].removed_volume - 1 | fabs) < 1e-12 and .cutting_time == $once[0].cutting_time' again.json > ok

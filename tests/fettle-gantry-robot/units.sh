# The same part, job and place in inches: the robot goes where it goes in mm. Reference: itself, in mm; the last step of a covering may be one more.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 1
make_place 25
fettle-grind plan.json --stock stock.stl --cell 0.2 --place place.txt \
    --gantry "exec:fettle-gantry-robot $ROBOT plan.json --stock stock.stl --cell 0.2 --moves mm.csv" > ground.pcd
jq '(1 / 25.4) as $in | .units.length = "in" | .anomaly |= map(map(. * $in)) | .tolerance *= $in | .safe_height *= $in | .wheel |= map_values(. * $in) | .force.stiffness /= $in |
    .feed.rate *= $in | .feed.step_over *= $in | .removal.coefficient *= $in * $in * $in' job.json > inches.json
jq '.units.length = "in" | .shape.z0 /= 25.4' surface.json > surface-in.json
fettle-plan inches.json surface-in.json > plan.json
awk '{ $4 /= NR < 4 ? 25.4 : 1; print }' OFMT=%.17g CONVFMT=%.17g place.txt > place-in.txt
fettle-grind plan.json --stock stock.stl --stock-units mm --cell 0.007874015748031496 --place place-in.txt \
    --gantry "exec:fettle-gantry-robot $ROBOT plan.json --stock stock.stl --stock-units mm --cell 0.007874015748031496 --moves in.csv" > ground.pcd
[ "$(wc -l < mm.csv)" -gt 500 ]
for file in mm in; do
    awk -F , 'NR == 2 { for (i = 1; i <= 3; ++i) low[i] = high[i] = $i } NR > 1 { for (i = 1; i <= 3; ++i) { if ($i < low[i]) low[i] = $i; if ($i > high[i]) high[i] = $i } }
        END { print "x,y,z\n" low[1] "," low[2] "," low[3] "\n" high[1] "," high[2] "," high[3] }' OFMT=%.9g $file.csv > $file-box.csv
done
fettle-diff --tol 0.01 mm-box.csv in-box.csv

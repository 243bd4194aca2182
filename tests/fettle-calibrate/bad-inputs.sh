# Rows and files that say nothing, too little or nonsense end with status 2 and one line that names the place.
refuses() { "$HERE/../refuses" "$1" fettle-calibrate "${@:2}"; }
head='avg_force_N,initial_wear,removed_mm3'
refuses 'missing.csv: cannot open' missing.csv
: > empty.csv
refuses 'empty.csv: no row' empty.csv
echo 'avg_force_N,removed_mm3' > short.csv
refuses 'short.csv: line 1: no column initial_wear' short.csv
printf '%s\n5,0,3\n5,0\n' $head > ragged.csv
refuses 'ragged.csv: line 3: 2 values, not 3' ragged.csv
printf '%s\n5,0,-3\n' $head > negative.csv
refuses 'negative.csv: line 2: removed_mm3 is not a positive number, got -3' negative.csv
printf '%s\nx,0,3\n' $head > word.csv
refuses 'word.csv: line 2: avg_force_N is not a positive number, got x' word.csv
printf '%s\n5,0,nan\n' $head > nan.csv
refuses 'nan.csv: line 2: removed_mm3' nan.csv
refuses '--before: goes with --job or --wheel' --before "$SAMPLES/scans/panel.pcd" "$SAMPLES/removal/static.csv"
refuses '--after: goes with' --after "$SAMPLES/scans/panel.pcd" "$SAMPLES/removal/static.csv"
refuses '--cell: goes with' --cell 1 "$SAMPLES/removal/static.csv"
refuses '--job: goes with --before' --job "$SAMPLES/jobs/wang1.json" "$SAMPLES/removal/static.csv"
refuses 'need --after' --wheel "$SAMPLES/wheels/rubber.json" --before "$SAMPLES/scans/panel.pcd" "$SAMPLES/removal/static.csv"
refuses 'needs trials at rest' --wheel "$SAMPLES/wheels/rubber.json" "$SAMPLES/removal/moving.csv"
refuses 'was not learnt' --known "$SAMPLES/wheels/rubber.json" "$SAMPLES/removal/static.csv"
fettle-calibrate "$SAMPLES/removal/static.csv" -o law.json
refuses 'moving.csv: records other conditions than the known law: speed' --known law.json "$SAMPLES/removal/moving.csv"
jq '.learnt.record.passes[3][0] = -1' law.json > bad.json
refuses 'bad.json: learnt.record.passes: pass 4: the force is not positive, got -1' --known bad.json "$SAMPLES/removal/static.csv"
refuses 'static.csv' --job "$SAMPLES/jobs/wang1.json" --before "$SAMPLES/scans/panel.pcd" "$SAMPLES/removal/static.csv"

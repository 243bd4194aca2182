# A trace is continued only by the run that wrote it: another plan, stock or option is refused by its name, and so are points that
# somebody has changed, a trace that says nothing about its run, and one that was cut short. Reference: the changes made here.
# A larger bound is no other run: it is what a run is continued with that ended at one.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
for encoding in --ascii ''; do
    status=0
    # shellcheck disable=SC2086
    jq '.bounds.coverings = 2' plan.json | fettle-grind --stock stock.stl --cell 0.2 --trace begun.pcd $encoding > ground.pcd 2> message || status=$?
    [ $status = 1 ]
    refused() { # NAMES FILTER [OPTION…]
        local names=$1 filter=$2
        shift 2
        jq "$filter" plan.json > other.json
        "$HERE/../refuses" "begun.pcd: does not match this plan and these options: another $names" \
            fettle-grind other.json --stock stock.stl --cell 0.2 --resume begun.pcd "$@"
    }
    refused job.wheel '.job.wheel.radius = 9'
    refused job.feed '.job.feed.rate = 19'
    refused job.tolerance '.job.tolerance = 0.2'
    refused job.removal '.job.removal.coefficient = 2'
    refused job.safe_height '.job.safe_height = 21'
    refused start '.start[2] += 0.1'
    refused step '.step = 0.4'
    refused surface '.surface.shape.z0 -= 1'
    refused passes 'del(.passes[3]) | .passes |= (to_entries | map(.value.pass = .key + 1 | .value))'
    refused --layer-1 . --layer-1 feed
    "$HERE/../refuses" 'another --stock' fettle-grind plan.json --stock stock.stl --cell 0.25 --resume begun.pcd
    jq '.anomalies[0].height = 3.9' part.json | fettle-part > other.stl
    "$HERE/../refuses" 'another --stock' fettle-grind plan.json --stock other.stl --cell 0.2 --resume begun.pcd
    # What was refused stays as it is, and goes on with the run's own plan.
    cp begun.pcd own.pcd
    fettle-grind plan.json --stock stock.stl --cell 0.2 --resume own.pcd --report report.json > ground.pcd
    jq -e .finished report.json > ok
done
fettle-grind plan.json --stock stock.stl --cell 0.2 --trace whole.pcd --ascii > ground.pcd
awk 'body && ++n == 9 { $3 -= 1 } { print } /^DATA/ { body = 1 }' whole.pcd > edited.pcd
grep -v '^# run' whole.pcd > unsigned.pcd
head -c 5000 whole.pcd > short.pcd
"$HERE/../refuses" 'edited.pcd: its points are not those that the run has written' fettle-grind plan.json --stock stock.stl --cell 0.2 --resume edited.pcd
"$HERE/../refuses" 'unsigned.pcd: does not say which run wrote it' fettle-grind plan.json --stock stock.stl --cell 0.2 --resume unsigned.pcd
"$HERE/../refuses" 'short.pcd: cut short: ' fettle-grind plan.json --stock stock.stl --cell 0.2 --resume short.pcd

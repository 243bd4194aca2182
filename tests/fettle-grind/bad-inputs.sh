# What is no plan, no stock, or no command line ends with status 2, one line that names the file and the value, and
# nothing on stdout.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 1
: > empty
jq '.layers.distance = 0.7' plan.json > layers.json
jq '.bounds.coverings = 0' plan.json > bounds.json
jq '.passes[1].from[0] += 1' plan.json > slanted.json
jq '.passes = []' plan.json > none.json
jq '.passes[2].from[0] = -5 | .passes[2].to[0] = -5' plan.json > back.json
jq '.passes[2].pass = 5' plan.json > order.json
jq '.layers.overlap_case = 1' plan.json > overlap.json
jq '.surface.shape = {type: "sphere", point: [0, 0, 5], normal: [0, 0, 1], curvature: -0.2}' plan.json > small.json
jq '.units.length = "in"' plan.json > units.json
jq '.pases = .passes' plan.json > misspelt.json
jq '.region.x = [30, 60] | .anomalies = []' part.json | fettle-part > beside.stl
refused() {
    status=0
    "$@" > out 2> message || status=$?
    [ $status = 2 ] && [ ! -s out ] && [ "$(wc -l < message)" = 1 ] || { echo "$*: $status"; cat message; }
    cat message
}
refused fettle-grind job.json --stock stock.stl
refused fettle-grind empty --stock stock.stl
refused fettle-grind layers.json --stock stock.stl
refused fettle-grind bounds.json --stock stock.stl
refused fettle-grind slanted.json --stock stock.stl
refused fettle-grind none.json --stock stock.stl
refused fettle-grind back.json --stock stock.stl
refused fettle-grind order.json --stock stock.stl
refused fettle-grind overlap.json --stock stock.stl
refused fettle-grind small.json --stock stock.stl
refused fettle-grind units.json --stock stock.stl
refused fettle-grind misspelt.json --stock stock.stl
refused fettle-grind plan.json --stock beside.stl --cell 0.1
refused fettle-grind plan.json --stock empty
refused fettle-grind plan.json --stock plan.json
refused fettle-grind plan.json --stock missing.stl
refused fettle-grind plan.json
refused fettle-grind plan.json --stock stock.stl --cell 0
refused fettle-grind plan.json --stock stock.stl --cell 1e-9
refused fettle-grind plan.json --stock stock.stl --gantry real
refused fettle-grind plan.json --stock stock.stl --trace missing/trace.pcd
refused fettle-grind plan.json --stock stock.stl --stock stock.stl
refused fettle-grind plan.json --stock stock.stl --gantry virtual:dynamic
refused fettle-grind plan.json --stock stock.stl --machine "$SAMPLES/machines/full_scale.json"
refused fettle-grind plan.json --stock stock.stl --gantry virtual:dynamic --machine job.json
refused fettle-grind plan.json --stock stock.stl --removal-factor 1e-200
refused fettle-grind plan.json --stock stock.stl --cell 3
jq '.job.wheel.radius = 1e15' plan.json > huge.json
jq '.job.wheel.width = 1e-5 | .job.feed.step_over = 1e-5' plan.json > thin.json
refused fettle-grind huge.json --stock stock.stl
refused fettle-grind thin.json --stock stock.stl
machine() { # FILTER: the sample, changed
    jq "$1" "$SAMPLES/machines/prototype.json" > machine.json
    refused fettle-grind plan.json --stock stock.stl --gantry virtual:dynamic --machine machine.json
}
machine '.servo_rate = 500'
machine '.axes.x.acceleration = 1e5'
machine '.axes.z.speed = 30'
machine '.axes.y.max = -2'
machine '.axes.y.min = 5'
machine '.axes.c.pitch_deg = 6'
machine '.spindle.tangential = 2'
machine 'del(.head.lvdt)'

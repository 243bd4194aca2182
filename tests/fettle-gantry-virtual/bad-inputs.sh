# What is no plan, no stock or no machine: status 2, one line, nothing on stdout.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
make_stock 0.01
: > empty
refused() {
    status=0
    "$@" > out 2> message < /dev/null || status=$?
    [ $status = 2 ] && [ ! -s out ] && [ "$(wc -l < message)" = 1 ] || { echo "$*: $status"; cat message; }
    cat message
}
refused fettle-gantry-virtual
refused fettle-gantry-virtual plan.json
refused fettle-gantry-virtual empty --stock stock.stl
refused fettle-gantry-virtual plan.json --stock empty
refused fettle-gantry-virtual plan.json --stock stock.stl --machine job.json
refused fettle-gantry-virtual plan.json --stock stock.stl --removal-factor 0

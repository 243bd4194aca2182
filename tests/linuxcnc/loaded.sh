# A minute of work (MINUTES of it, by hand) while every core has two other things to do: no false stop. A stop would be an error in
# place of an answer.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
jq '.job.safe_height = 6 | .job.removal.coefficient = 0.01' plan.json > light.json
make_stock 0.01
fettle-stock-linuxcnc light.json --stock stock.stl --cell 0.2 > before
start before
load=()
for _ in $(seq $((2 * $(nproc)))); do
    while :; do :; done &
    load+=($!)
done
trap 'kill "${load[@]}"; [ -e machine/run/stop ] || "$machine/stop" machine' EXIT
talk_to light.json
mapfile -t ys < <(seq -5.9 0.1 6)
end=$((SECONDS + 60 * ${MINUTES:-1}))
passes=0
while [ $SECONDS -lt $end ]; do
    send "travel $((passes % 10 - 5)) -6 4.8"
    for y in "${ys[@]}"; do send "move $((passes % 10 - 5)) $y 4.8 20"; done
    passes=$((passes + 1))
done
send quit
stop
echo "$passes passes in ${MINUTES:-1} min, no stop"

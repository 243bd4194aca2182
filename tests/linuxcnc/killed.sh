# A client that is killed with -9 in the cut, 50 times: each time the machine is at rest without force 0.25 s after the last
# heartbeat, and the next client finds a machine that works. Reference: every period of the servo thread.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
jq '.job.safe_height = 6 | .job.removal.coefficient = 0.01' plan.json > light.json
make_stock 0.01
fettle-stock-linuxcnc light.json --stock stock.stl --cell 0.2 > before
start before
record
RANDOM=1
mapfile -t ys < <(seq -5.9 0.1 0)
for k in {1..50}; do
    talk_to light.json
    send "travel 0 -6 $(printf '4.%02d' $((80 - k)))"
    for y in "${ys[@]:0:$((RANDOM % 30 + 30))}"; do send "move 0 $y 4.3 20"; done
    kill_driver light.json
    sleep 0.6
done
end_record
stop
stop_times > times
sort -n times | awk '{ print $1 " ms, " $2 " N"; if ($1 > 250 || $2 <= 0) bad = 1 } END { print NR " times"; exit bad || NR != 50 }'

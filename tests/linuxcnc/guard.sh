# The guard on stock that barely yields: a move down ends at F_max (15 N on a spring of 10 N/mm), so does a step that climbs a hill; a force
# above the hard limit switches the machine off, and says so; the next client finds a machine that works. References: the spring;
# what the machine needs to stop, 0.4 mm from 20 mm/s with blended corners and two periods.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
jq '.job.safe_height = 10 | .job.removal.coefficient = 1e-6' plan.json > hard.json
make_stock 4
fettle-stock-linuxcnc hard.json --stock stock.stl --cell 0.2 > before
start before
talk_to hard.json
field() { cut -d ' ' -f "$1" <<< "$answer"; }
between() { awk -v a="$1" -v min="$2" -v max="$3" 'BEGIN { exit !(a >= min && a <= max) }' || { echo "$answer: $1"; exit 1; }; }
send 'travel -5 -6 3'
between "$(field 6)" 3.2 3.5
between "$(field 8)" 15 18
send 'lift 6'
between "$(field 8)" 0 0
send 'travel 0.5 -13 5.2'
send 'move 0.5 2 5.2 20'
between "$(field 5)" -12 1.9
between "$(field 9)" 15 30
send 'lift 10'
inside halcmd setp trip.in0 10
printf '99 travel -5 -6 3\n' >&"${DRIVER[1]}"
read -r answer <&"${DRIVER[0]}"
[[ $answer == '99 error the force has passed the machine'"'"'s hard limit; it is off' ]] || { echo "$answer"; exit 1; }
printf '100 quit\n' >&"${DRIVER[1]}"
wait "$DRIVER_PID" || true
inside halcmd setp trip.in0 267
talk_to hard.json
send 'travel -5 -6 6'
between "$(field 6)" 5.99 6.01
send quit
stop

# LinuxCNC begins, is used and ends: a conversation by hand, and after it no process, no shared memory and no file outside is left.
# References: the protocol; the part's height, 5 mm; the wheel's radius, 10 mm.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 30
make_stock 0.01
fettle-stock-linuxcnc plan.json --stock stock.stl --cell 0.2 > before
state() { ipcs -m | grep -c '^0x' || true; find /tmp -maxdepth 1 -name 'linuxcnc*'; find /dev/shm -type f; }
state > outside
start before
talk_to plan.json
[[ $answer =~ ^3\ ok\ [0-9.]+\ -?[0-9.e-]+\ -?[0-9.e-]+\ ([0-9.]+)\  ]] && awk -v z="${BASH_REMATCH[1]}" 'BEGIN { exit !(z >= 20) }'
near() { awk -v a="$1" -v b="$2" -v tol="$3" 'BEGIN { exit !(a >= b - tol && a <= b + tol) }' || { echo "$answer: $1 is not $2"; exit 1; }; }
field() { cut -d ' ' -f "$1" <<< "$answer"; }
send touch_off
near "$(field 3)" 10 0.005
send 'travel -3 -3 4.9'
near "$(field 6)" 4.9 0.01
send 'move -3 3 4.9 20'
send 'lift 8'
near "$(field 6)" 8 0.01
near "$(field 8)" 0 0
send 'probe 0.5 -0.5 2'
near "$(field 3)" 5.01 0.005
send 'probe 30 30 3'
[ "$(field 3)" = none ]
send change_wheel
send quit
wait "$DRIVER_PID"
stop
state | diff outside -
if pgrep -f "$PWD/machine" > left; then cat left; exit 1; fi
# The wheel has been at work in the middle of its way, and nowhere else.
fettle-stock-linuxcnc plan.json --stock stock.stl --cell 0.2 --after machine/run/stock.ground --ascii > ground.pcd
awk '!data { data = /^DATA/; next } $4 > 0.01 { ++deep; if ($1 < -5 || $1 > -1 || $2 < -5.5 || $2 > 5.5) exit 1 } END { exit deep < 50 }' ground.pcd

# Steps of 0.01 in at 1 in/s, one after the other as the answers come: between its first and its last motion the machine never
# stops. Reference: every period of the servo thread.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
make_stock 0.01
fettle-stock-linuxcnc plan.json --stock stock.stl --cell 0.2 > before
start before
chrt --fifo --pid 1 $$ 2> nothing || true # the sender stands before other work, as the driver does
talk_to plan.json
send 'travel 0 0 10'
# Made before: making one takes as long as the machine needs for it. The first is longer: LinuxCNC blends it with the next one only if that
# comes in its first half.
mapfile -t ys < <(awk 'BEGIN { for (i = 10; i <= 400; ++i) printf "%.3f\n", i * 0.254 }')
record
for y in "${ys[@]}"; do send "move 0 $y 10 25.4"; done
send status
sleep 0.3
end_record
send quit
stop
awk '{ v = NR > 1 ? $2 - y : 0; y = $2; moved[NR] = v > 1e-6; if (v > 1e-6) { if (!first) first = NR; last = NR } }
    END { for (i = first; i <= last; ++i) standing += !moved[i]
        printf "%d ms of motion, %d standing still, %.3f in/s\n", last - first + 1, standing, y / 25.4 / (last - first + 1) * 1000
        exit !(last - first > 3900 && standing == 0) }' record

# Manual mode on LinuxCNC: back and forth over the raw H of Wang's part 1 at 1 in/s, held on it by an offset of Z in the servo thread:
# the force stays within a tenth of the 10 lbf for at least 95 % of the time of contact, and metal is removed. Then a client that is
# killed with -9 while it presses, 5 times. References: the set force; every period of the servo thread.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
fettle-part "$SAMPLES/parts/wang1.json" > part.stl
fettle-stock-linuxcnc "$SAMPLES/jobs/wang1.json" --stock part.stl > before
# The machine is over its zero; the steering begins over the middle of the part.
middle=$(jq '.region | (.x[0] + .x[1]) / 2' "$SAMPLES/parts/wang1.json")
awk -v way="$middle" 'BEGIN { time = way * sqrt(2); print "0 1 1 up" } { $1 += time; print }' "$SAMPLES/steering/h.txt" > steer.txt
start before
record
fettle-manual "$SAMPLES/jobs/wang1.json" --stock part.stl --gantry "exec:$(driver "$SAMPLES/jobs/wang1.json")" \
    --steer steer.txt --lowest -0.1 --trace trace.pcd --report report.json > seen.pcd
jq -c '[.within, .contact_time, .removed_volume, .peak_force]' report.json
jq -e '.within >= 0.95 and .contact_time > 20 and .removed_volume > 0.1 and .peak_force < 15' report.json > ok
# The servo thread itself sees it too: contact is more than a twentieth of the force.
awk -v lbf=4.4482216 '{ f = $4 / lbf } f > 0.5 { ++n; if (f >= 9 && f <= 11) ++good }
    END { print n " ms, " good / n; exit !(n > 20000 && good >= 0.95 * n) }' record

job=$SAMPLES/jobs/wang1.json
mapfile -t ys < <(seq 10 0.25 30)
for k in {1..5}; do
    talk_to "$job"
    send 'travel 20 10 50'
    for y in "${ys[@]}"; do send "press 20 $y 0 25 44.5"; done
    kill_driver "$job"
    sleep 0.6
done
end_record
stop
stop_times > times
sort -n times | awk '{ print $1 " ms, " $2 " N"; if ($1 > 250 || $2 <= 0) bad = 1 } END { print NR " times"; exit bad || NR != 5 }'

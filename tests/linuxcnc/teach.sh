# Four points of Wang's part 3 shown on LinuxCNC from its zero on: where the events lead at 1 in/s, touched on the sphere within 0.0005 in,
# with the C axis at θ. References: the formulas; the encoder of the C axis.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
fettle-part "$SAMPLES/parts/wang3.json" > part.stl
jq '.safe_height = 1.6 | .frame.theta_deg = 20 | .surface = {type: "plane"}' "$SAMPLES/jobs/wang3.json" > job.json
printf '%s\n' '0 1 1' '0.707 record' '0.707 1 0' '2.707 record' '2.707 0 1' '4.707 record' '4.707 -1 0' '6.707 record' > steer.txt
fettle-stock-linuxcnc job.json --stock part.stl --cell 0.004 > before
start before
fettle-teach job.json --gantry "exec:$(driver job.json)" --steer steer.txt < /dev/null > taught.json
turned=$(inside halcmd getp joint.3.pos-fb)
stop
awk -v turned="$turned" 'BEGIN { exit !(turned > 19.99 && turned < 20.01) }'
jq -e '.anomaly | ([map(.[:2]), [[0.5, 0.5], [2.5, 0.5], [2.5, 2.5], [0.5, 2.5]]] | map(flatten) | transpose | map(.[0] - .[1] | fabs) | max) < 0.01 and
    (map(((.[0] - 1.5) as $x | (.[1] - 1.5) as $y | (.[2] + 3) as $z | $x * $x + $y * $y + $z * $z | sqrt) - 4 | fabs) | max) < 0.0005' taught.json

# Boundary points of Wang's parts shown on simulated gantries, by events from a file. References: where the events lead at 1 in/s, the
# formulas of the parts, what was answered, the turn of the C axis by its speed and acceleration.
fettle-part "$SAMPLES/parts/wang1.json" > plane.stl
fettle-part "$SAMPLES/parts/wang3.json" > sphere.stl
teach() { fettle-teach "$SAMPLES/jobs/$1.json" --steer "$SAMPLES/steering/teach.txt" --report report.json "${@:2}"; }
places='def near($to): [., $to] | transpose | map(.[0][:2] as $a | .[1] as $b | [$a[0] - $b[0], $a[1] - $b[1]] | map(fabs) | max) | max < 0.01;
    (.anomaly | near([[0.5, 0.5], [1.5, 0.5], [2.5, 0.5], [2.5, 1.5], [2.5, 2.5], [1.5, 2.5], [0.5, 2.5], [0.5, 1.5]])) and
    (.sampling | near([[0.1, 0.1], [2.9, 0.1], [2.9, 2.9], [0.1, 2.9]]))'
answer() { printf '%s\n' "$@"; }

# What is answered: θ, surface, its direction, start; the next tools take the job.
answer 30 swept 45 start | teach wang1 --gantry virtual --stock plane.stl > swept.json
jq -e "$places and .frame.theta_deg == 30 and .surface == {\"type\": \"swept\", \"direction_deg\": 45} and
    (.anomaly + .sampling | map(.[2] - 0.75 | fabs) | max) < 0.00011" swept.json > ok
jq -e '(has("mode") | not) and .units.length == "in" and (.anomaly_area - 4 | fabs) < 0.1 and .anomaly_points == 8 and .sampling_points == 4 and .touches_without_surface == 0' report.json > ok
answer freeform | teach wang3 --gantry virtual --stock sphere.stl --theta 10 > sphere.json
fettle-sample sphere.json --on sphere.stl | fettle-fit sphere.json > surface.json
jq -e '.kind == "surface"' surface.json > ok
# Options that are given are not prompted for.
answer start | teach wang1 --gantry virtual --stock plane.stl --theta 30 --surface swept --direction 45 > given.json
cmp swept.json given.json

# On the sphere, to the resolution of the drive's encoder (0.0001 in) and diagonals of 0.03 in cells sink (2 · 0.03² / 32), with a point or a ball.
on_sphere='.anomaly + .sampling | map(((.[0] - 1.5) as $x | (.[1] - 1.5) as $y | (.[2] + 3) as $z | $x * $x + $y * $y + $z * $z | sqrt) - 4 | fabs) | max'
jq -e "$on_sphere < 0.0002" sphere.json > ok
jq '.probe.tip_radius = 0.1' "$SAMPLES/jobs/wang3.json" > tip.json
fettle-teach tip.json --gantry virtual --stock sphere.stl --steer - < "$SAMPLES/steering/teach.txt" > ball.json
jq -e "$on_sphere < 0.0002" ball.json > ok

# With drives: the head turns by 90° at 90°/s and 360°/s² before anything else.
for theta in 0 90; do
    teach wang1 --gantry virtual:dynamic --machine "$SAMPLES/machines/full_scale.json" --stock plane.stl --theta $theta < /dev/null > dynamic.json
    jq -e "$places" dynamic.json > ok
    jq .machine_time report.json >> times
done
awk 'NR == 1 { first = $1 } END { exit !($1 - first > 1.2 && $1 - first < 1.4) }' times

# Through a driver: the same as beneath the tool's own gantry; it is homed to θ before the first touch.
teach wang1 --gantry virtual --stock plane.stl --theta 30 < /dev/null > direct.json
teach wang1 --theta 30 < /dev/null --gantry "exec:tee lines | fettle-gantry-virtual $PWD/direct.json --stock $PWD/plane.stl" > driven.json
jq -e "$places" driven.json > ok
# The stick may rest.
awk 'NR == 3 { print $1, 0, 0 } NR > 2 { $1 += 1 } { print }' "$SAMPLES/steering/teach.txt" > rest.txt
fettle-teach "$SAMPLES/jobs/wang1.json" --gantry virtual --stock plane.stl --theta 30 --steer rest.txt < /dev/null > rest.json
fettle-diff --tol 1e-9 direct.json rest.json > same
awk '$2 == "home" { homed = $3 > 0.5235 && $3 < 0.5237 } $2 == "probe" { n++; if (!homed) exit 1 } END { exit n != 12 }' lines

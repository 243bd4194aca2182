# The hill on the machine with drives and sensors: ground to the plane within the tolerance, and not below it by more than the
# corners and the servo loops account for, 0.01. The head turns to theta first, which takes time; the same seed, the same bytes;
# another seed, other readings. References: the plane, the part's symmetry, and each other.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_stock 4
grind() { # SEED
    fettle-grind plan.json --stock stock.stl --cell 0.1 --gantry virtual:dynamic --machine "$SAMPLES/machines/full_scale.json" \
        --seed "$1" --trace trace.pcd --report report.json --ascii
}
make_job 0
grind 1 > ground.pcd
awk '/^DATA/ { body = 1; next }
     body && $1 > -6 && $1 < 6 && $2 > -6 && $2 < 6 { if ($3 > 5.1 || $3 < 5 - 0.01) bad++; n++ }
     END { exit bad > 0 || n != 120 * 120 }' ground.pcd
jq -e '.finished and .layers == 2 and (.machine_time - .grinding_time - .travel_time - .service_time | fabs) < 1e-6' report.json > ok
cp trace.pcd first.pcd
grind 1 | cmp - ground.pcd
cmp trace.pcd first.pcd
grind 2 > other.pcd
if cmp -s trace.pcd first.pcd; then exit 1; fi

# 30 degrees at 90 a second and 360 a second squared: 30/90 + 90/360 s before the first touch-off of 10 s.
first_touch() { awk 'body { print $4; exit } /^DATA/ { body = 1 }' trace.pcd; }
grind 1 > ground.pcd
straight=$(first_touch)
make_job 30
grind 1 > ground.pcd
turned=$(first_touch)
awk -v a="$straight" -v b="$turned" 'BEGIN { d = b - a - (30 / 90 + 90 / 360); exit d < -0.001 || d > 0.1 }'

# A wheel too big for the spindle stalls it: status 1, the fault is reported, and the trace ends in event 12.
jq '.spindle.power = 1 | .spindle.inertia = 1e-6' "$SAMPLES/machines/full_scale.json" > weak.json
status=0
fettle-grind plan.json --stock stock.stl --gantry virtual:dynamic --machine weak.json --trace trace.pcd --ascii > ground.pcd 2> message || status=$?
[ $status = 1 ]
grep -q 'the spindle stalls' message
[ "$(tail -n 1 trace.pcd | cut -d ' ' -f 7)" = 12 ]

# The mode is changed in the middle of the work, and back: by hand along Y over the hill with the set force, stopped by the space of the
# joystick, and on by itself to the end. What was ground by hand is not there any more. References: the plane; the set force; the
# times in the steering.
# shellcheck source=tests/fettle-station/kit.bash
. "$HERE/kit.bash"
make_job 0
make_stock 4
{ show; cat << 'END'
3 start
45 stop
45 manual
45 start
45 -1 -1 up
46 0 1
47 stop
47 start
48 0 -1
48.5 next
48.5 automatic
48.5 start
END
} > steer.txt
station session steer.txt --gantry virtual:dynamic --machine "$machine" --force 8 --report report.json
jq -e '.finished and .manual_runs == 2 and (.stops | length) == 3 and ([.stops[] | .free - .asked] | max) <= 0.25' report.json > ok
is_flat "$(jq .prediction.shift session/surface.json)" session/ground.pcd
# With the wheel on the part the force is that of --force.
rows session/manual-1.pcd | awk '$9 > 0 && $8 > 0.4 { n++; if ($8 > 7.2 && $8 < 8.8) good++ } END { print good / n; exit !(n > 20 && good > 0.8 * n) }'
# fettle-grind goes on with the same files, and has nothing to do; it knows nothing of what was done by hand.
cp session/trace.pcd trace.pcd
fettle-grind session/plan.json --stock stock.stl --cell 0.2 --gantry virtual:dynamic --machine "$machine" --resume trace.pcd --ascii > ground.pcd
fettle-diff --tol 1e-6 trace.pcd session/trace.pcd

# Manual from the beginning; the end of the session ends it. A machine that cannot hold a force says so.
{ show; printf '%s\n' '3 manual' '3 start' '30 0 1' '31 end'; } > steer.txt
station hand steer.txt --gantry virtual:dynamic --machine "$machine" --report report.json
jq -e '.mode == "manual" and .stage == "stopped" and .manual_runs == 1' report.json > ok
[ ! -e hand/trace.pcd ]
ends_with 1 station ideal steer.txt --gantry virtual --report report.json
jq -e '.stage == "review" and .manual_runs == 0' report.json > ok

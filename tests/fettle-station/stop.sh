# Stopped at 24 moments of its work, on the machine with drives: the wheel is off the part no later than 0.25 s after the stop, by the
# trace; the machine then stands at the safe height. The work goes on, and ends as it should. References: the time of the stop in the
# steering; the plane.
# shellcheck source=tests/fettle-station/kit.bash
. "$HERE/kit.bash"
make_job 0
make_stock 4
work() { # FOLDER STATUS LINES…: after the touches
    { show; printf '%s\n' "${@:3}"; } > steer.txt
    ends_with "$2" station "$1" steer.txt --gantry virtual:dynamic --machine "$machine" --report report.json
}
# When the grinding begins, in steering time; and how long it takes.
work whole 0 '3 start'
whole=$(rows whole/trace.pcd | awk 'END { print $4 }')
work first 1 '3 start' '40 stop' '40 end'
begun=$(jq '40 - .stops[0].asked' report.json)
shift=$(jq .prediction.shift whole/surface.json)
RANDOM=1
for n in {1..24}; do
    random=$RANDOM
    at=$(awk -v b="$begun" -v t="$whole" -v n="$n" -v r=$random 'BEGIN { print b + t * (n - 1 + r / 32768) / 25 }')
    work "$n" 1 '3 start' "$at stop" "$at end"
    jq -c '[.stops[] | .asked, .free - .asked, .lifted - .free]' report.json
    # Also where the wheel is measured, at the plate beside the work: the machine looks every 0.05 s.
    jq -e --argjson at "$at" --argjson begun "$begun" '.stage == "stopped" and (.stops | length) == 1 and
        (.stops[0] | (.asked - ($at - $begun) | . > -0.002 and . < 0.06) and .free - .asked <= 0.25 and .lifted >= .free)' report.json > ok
    # Two rows of the trace: the wheel is above where it was in the cut, though the damped head's spring still relaxes, or it has not touched
    # the part on its way down, where the spring shows no more force than on the way up through the air; and at the safe height.
    rows "$n/trace.pcd" | awk -v free="$(jq '.stops[0].free' report.json)" '{ event = $7; z[NR] = $3; time[NR] = $4; peak[NR] = $10 }
        END { off = z[NR - 1] >= z[NR - 2] + 1.5 || z[NR - 1] > 19.99 || peak[NR - 1] < 0.2 || (z[NR - 2] > 19.99 && peak[NR - 1] <= peak[NR])
            exit !(event == 14 && z[NR] > 19.99 && off && time[NR - 1] - free < 1e-6 && free - time[NR - 1] < 1e-6) }'
    { echo '0 start'; } > on.txt
    station "$n" on.txt --gantry virtual:dynamic --machine "$machine" --resume --report report.json
    jq -e '.finished' report.json > ok
    is_flat "$shift" "$n/ground.pcd"
done

# Go on at once, in the same session, again and again.
{ show; echo '3 start'; for k in 1 2 3 4; do awk -v b="$begun" -v t="$whole" -v k=$k 'BEGIN { at = b + t * k / 6; print at, "stop"; print at, "start" }'; done; } > steer.txt
station again steer.txt --gantry virtual:dynamic --machine "$machine" --report report.json
jq -e '.finished and (.stops | length) == 4 and ([.stops[] | .free - .asked] | max) <= 0.25' report.json > ok
is_flat "$shift" again/ground.pcd

# Stopped while the surface is touched around a smaller B: the touches that were made are kept, the others follow after the next start.
touched() { # LINE…: steering after the start, which is at 4.15 s
    { awk 'BEGIN {
          n = split("-4 -4 4 -4 4 4 -4 4 -7 -7 7 -7 7 7 -7 7", c, " ") / 2
          for (i = 1; i <= n; ++i) {
              dx = c[2 * i - 1] - x; dy = c[2 * i] - y
              printf "%.6f %g %g\n", t, dx, dy
              t += sqrt(dx * dx + dy * dy) / 20; x += dx; y += dy
              printf "%.6f record\n", t
              if (i % 4 == 0) printf "%.6f next\n", t }
          printf "%.6f start\n", t }'; printf '%s\n' "$@"; } > steer.txt
}
touched '14 stop' '14 end'
ends_with 1 station between steer.txt --gantry virtual:dynamic --machine "$machine"
jq -e '.stage == "touch" and .stops == [] and (.touches | length | . >= 1 and . < 15)' between/session.json > ok
touched '14 stop' '14 start' '60 start'
station goes-on steer.txt --gantry virtual:dynamic --machine "$machine" --report report.json
jq -e '.finished and .touches == 15' report.json > ok
jq -e -n --slurpfile a between/session.json --slurpfile b goes-on/session.json '$a[0].touches as $first | $b[0].touches[:$first | length] == $first' > ok

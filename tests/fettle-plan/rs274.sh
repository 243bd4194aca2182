# LinuxCNC's own interpreter follows the program for LinuxCNC without a complaint to the places of the plan: its first and last tool
# points, C turned to θ, units in inches, feed 60 in/min.
command -v rs274 > /dev/null || { echo "rs274 (linuxcnc-uspace) is not installed"; exit 77; }
echo '{"kind": "surface", "units": {"length": "in"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 0.75, "slope": [0, 0]}}' > plane.json
jq '.frame.theta_deg = 30' "$SAMPLES/jobs/wang1.json" > turned.json
fettle-plan turned.json plane.json > plan.json
fettle-plan turned.json plane.json --gcode linuxcnc > layer1.ngc
printf 'T1 P1 D0 Z0\n' > tool.tbl
rs274 -t tool.tbl -g layer1.ngc > canon 2> messages
! grep -i error messages || exit 1
grep -q 'USE_LENGTH_UNITS(CANON_UNITS_INCHES)' canon
grep -q 'SET_FEED_RATE(60.0*)' canon
# X Y Z A B C of a feed
grep 'STRAIGHT_FEED' canon | sed 's/.*(\(.*\))/\1/' | tr -d ',' | awk '$6 != 30 { exit 1 } $3 > 1.99 { next } { print $1, $2 }' > places
jq -r '[.passes[].from], [.passes[].to] | length' plan.json > counts
passes=$(head -n 1 counts)
[ "$(wc -l < places)" = $((2 * passes)) ]
jq -r '.passes[] | (.from, .to) | "\(.[0]) \(.[1])"' plan.json > ends
# odd passes run forwards, even ones backwards; rs274 prints four decimals
paste -d' ' ends places | awk '{ key[NR] = $1 " " $2; at[NR] = $3 " " $4 }
    END { for (i = 1; i <= NR; i++) { j = (int((i - 1) / 2) % 2) ? (i % 2 ? i + 1 : i - 1) : i; split(key[j], k, " "); split(at[i], a, " ")
          for (c = 1; c <= 2; c++) if (k[c] - a[c] > 1e-4 || a[c] - k[c] > 1e-4) { print i, key[j], at[i]; exit 1 } } }'

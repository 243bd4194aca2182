# On a terminal: an arrow key moves by 0.1 s at 1 in/s, buttons wait until the stick rests, and the terminal is left as it was. A bad
# answer is prompted for again. References: the numbers; the terminal before.
command -v script > /dev/null || { echo 'script (bsdutils) is not installed' >&2; exit 77; }
fettle-part "$SAMPLES/parts/wang1.json" > part.stl
on_terminal() { timeout 60 script -qec "bash $1" /dev/null > "$2"; }
teach="fettle-teach $SAMPLES/jobs/wang1.json --gantry virtual --stock part.stl"
cat > keys.sh << END
stty -g > before
$teach --steer /dev/tty -o keys.json < /dev/null
stty -g > after
END
# Keys that mean nothing, and a while without any, change nothing.
other=$'\033[F' up=$'\033[A' down=$'\033[B' right=$'\033[C' left=$'\033[D'
{ printf r; sleep 0.5; printf %s "${other}${right}r${up}r${left}ru${down}${left} xnq"; } | on_terminal keys.sh shown
cmp before after
jq -e '(.anomaly | map(.[:2]) | [., [[1.5, 1.5], [1.6, 1.5], [1.6, 1.6], [1.5, 1.6]]] | map(flatten) | transpose | map(.[0] - .[1] | fabs) | max) < 0.006 and
    (has("sampling") | not)' keys.json > ok

echo "$teach --steer $SAMPLES/steering/teach.txt -o asked.json" > ask.sh
printf '%s\n' left 30 round swept 45 start | on_terminal ask.sh shown
jq -e '.frame.theta_deg == 30 and .surface == {"type": "swept", "direction_deg": 45}' asked.json > ok
grep -q "'left' is not a number" shown
grep -q "'round' is none of plane, swept, freeform" shown
grep -q 'anomaly 8: (' shown
[ "$(grep -c 'axis, degrees \[0' shown)" = 2 ]

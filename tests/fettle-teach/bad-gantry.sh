# What is no gantry, no teaching or no answer: status 2, one line, nothing on stdout.
fettle-part "$SAMPLES/parts/wang1.json" > part.stl
job=$SAMPLES/jobs/wang1.json
steer=$SAMPLES/steering/teach.txt
refuses() { "$HERE/../refuses" "$1" fettle-teach "$job" "${@:2}"; }
on() { refuses "$1" --gantry virtual --stock part.stl --steer "$steer" "${@:2}"; }
refuses 'or --gantry must be given, not both' --gantry virtual --anomaly part.stl
refuses "'real' is none of" --gantry real --steer "$steer"
refuses "'exec:' is none of" --gantry exec: --steer "$steer"
refuses '--machine: goes with' --gantry virtual --machine m.json --stock part.stl --steer "$steer"
refuses '--machine: goes with' --gantry virtual:dynamic --stock part.stl --steer "$steer"
refuses '--stock: goes with' --gantry virtual --steer "$steer"
refuses '--stock: goes with' --gantry exec:true --stock part.stl --steer "$steer"
refuses '--steer: goes with' --gantry virtual --stock part.stl
refuses 'ended with status 3' --gantry 'exec:exit 3' --steer "$steer"
refuses '--sampling, --file-units, --on: go with' --gantry virtual --stock part.stl --steer "$steer" --sampling part.stl
on "is not a number" < <(echo left)
on "none of plane, swept, freeform" < <(printf '0\nround\n')
on "none of start, stop" < <(printf '0\nplane\nslow\n')
on 'stopped by the operator' < <(printf '0\nplane\nstop\n')
on '--direction: goes with' --direction 3

teach() { refuses "$1" --gantry virtual --stock part.stl --steer events; }
printf '0 record\n0 next\n' > events
teach 'the job that was taught: anomaly'
printf '0 record\n0 1 0\n1 record\n1 0 1\n2 record\n2 record now\n' > events
teach "events: line 6: '2 record now' is none of"
printf '0 push\n' > events
teach "events: line 1: '0 push' is none of"
jq '.safe_height = 0.5' "$job" > low.json
"$HERE/../refuses" 'safe_height 0.5 is not above' fettle-teach low.json --gantry virtual --stock part.stl --steer "$steer"

# Beside the part the probe meets nothing: the point has no z, and that is said.
printf '0 record\n0 1 0\n0.5 record\n0.5 0 1\n3.5 record\n' > events
fettle-teach "$job" --gantry virtual --stock part.stl --steer events < /dev/null > beside.json 2> said
grep -q '1 point found no surface' said
jq -e '[.anomaly[] | length] == [3, 3, 2]' beside.json > ok

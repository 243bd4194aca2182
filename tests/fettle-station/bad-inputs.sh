# What is no session, no machine, no steering or no command line: status 2, one line that names the place.
# shellcheck source=tests/fettle-station/kit.bash
. "$HERE/kit.bash"
make_job 0
make_stock 4
printf '0 end\n' > fine
refuses() { "$HERE/../refuses" "$1" fettle-station job.json --cell 0.2 "${@:2}"; }
on() { refuses "$1" --stock stock.stl --gantry virtual --steer fine "${@:2}"; }
refuses '--session is required' --gantry virtual --stock stock.stl --steer fine
refuses "--gantry: '' is none of" --session s --stock stock.stl --steer fine
refuses "'real' is none of" --session s --gantry real --steer fine
refuses '--stock: goes with a virtual gantry' --session s --gantry virtual --steer fine
refuses '--machine: goes with' --session s --gantry virtual:dynamic --stock stock.stl --steer fine
refuses 'ended with status 3' --session s1 --gantry 'exec:exit 3' --steer fine
refuses 'none: cannot open' --session s --gantry virtual --stock stock.stl --steer none
refuses '--joystick: goes with the keys of a terminal' --session s --gantry virtual --stock stock.stl --steer fine --joystick fine
refuses '--direction: goes with a swept surface alone' --session s --gantry virtual --stock stock.stl --steer fine --direction 3
refuses "line 1: '0 jump' is none of" --session s --gantry virtual --stock stock.stl --steer <(echo '0 jump')
on 'missing/s: no folder for a session' --session missing/s
on 'stock.stl: no folder for a session' --session stock.stl
: > garbage
refuses 'garbage' --session s2 --gantry virtual --stock garbage --steer fine
# A session that is there is not begun anew, nor gone on with by another job.
status=0
station kept fine --gantry virtual 2> said || status=$?
[ $status = 1 ]
on 'kept/session.json: holds a session: --resume goes on with it' --session kept
jq '.tolerance = 0.2' job.json > other.json
"$HERE/../refuses" 'kept/session.json: belongs to another job than other.json' fettle-station other.json --session kept --resume --gantry virtual --stock stock.stl --steer fine
echo '{' > kept/session.json
on 'kept/session.json: ' --session kept --resume
jq -n '{kind: "job"}' > kept/session.json
on 'kept/session.json: ' --session kept --resume

# What cannot be done is said, and the session goes on: two points are no boundary, nor are crossed ones; the end of the file is that of the session.
printf '0 record\n0 1 0\n0.2 record\n0.2 next\n0.2 end\n' > two.txt
status=0
station two two.txt --gantry virtual --report report.json 2> said || status=$?
[ $status = 1 ]
jq -e '.stage == "anomaly"' report.json > ok
jq -e '.anomaly | length == 2' two/session.json > ok

# A driver that dies in the middle of a move is said, and started anew for the next one.
printf '0 1 0\n1 0 0\n1 record\n1 end\n' > move.txt
virtual="fettle-gantry-virtual job.json --stock stock.stl --cell 0.2"
ends_with 1 fettle-station job.json --session anew --lowest 0 --steer move.txt --patience 5 \
    --gantry "exec:if [ -e begun ]; then touch begun_again && exec $virtual; else touch begun && exec $HERE/../fettle-grind/faulty-driver dies 6 $virtual; fi"
grep -q 'was killed by signal 9; stopped' said
[ -e begun_again ]
jq -e '.stage == "anomaly" and (.anomaly | length) == 1' anew/session.json > ok

# The anomaly stands higher than probe and wheel travel: touching does not begin, and why is said also where there is no screen.
make_job 0
jq '.safe_height = 8' job.json > low.json
{ show; echo '3 start'; } > grind.txt
ends_with 1 fettle-station low.json --session low --gantry virtual --stock stock.stl --cell 0.2 --lowest 0 --steer grind.txt --report report.json
grep -q 'stock.stl: stands at z 9, not below safe_height 8' said
jq -e '.stage == "touch" and .touches == 0 and (.finished | not)' report.json > ok

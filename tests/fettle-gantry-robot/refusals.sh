# What the robot does not reach is refused before anything is ground: status 2 and one line that names the place, the joint and its value; and so is a driver that knows no
# frames. What becomes wrong later ends the run with status 1, and the trace holds what was done. References: the robot's file, changed so that one thing is wrong.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 1
make_place 25
grind() { # DRIVER [OPTION…]
    fettle-grind plan.json --stock stock.stl --cell 0.2 --trace trace.pcd --ascii --place place.txt --gantry "exec:$1" "${@:2}"
}
robot() { echo "fettle-gantry-robot $1 plan.json --stock stock.stl --cell 0.2"; }
refused() { # WORDS DRIVER [OPTION…]
    status=0
    rm -f trace.pcd
    grind "${@:2}" > out 2> message || status=$?
    [ $status = 2 ] && [ ! -s out ] && grep -q '^POINTS 0*$' trace.pcd && [ "$(wc -l < message)" = 1 ] && grep -q -- "$1" message || { echo "$2: $status"; cat message; exit 1; }
}
frame="does not take the job.s frame: "
refused "${frame}no such command: frame; stopped" 'sed -u "s/^\([0-9]*\) .*/\1 ok fettle-gantry 1 -500 500 -500 500 -500 500 100 999/;2s/ok.*/error no such command: frame/"'
refused "${frame}the machine has a frame of its own" 'fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2'

sed 's/ 1000$/ 3000/' place.txt > far.txt
cp place.txt here.txt
cp far.txt place.txt
refused "${frame}the pose at 0 0 20 mm is out of the arm's reach: the flange would be .* mm from the base" "$(robot "$ROBOT")"
cp here.txt place.txt
jq '.dh[4].max_deg = 20 | .dh[4].min_deg = -20' "$ROBOT" > stiff.json
refused "${frame}the pose at .* mm: joint 5 would be at .* degrees, out of its range of -20 to 20" "$(robot stiff.json)"
jq '.track.min = 1300 | .dh[0].min_deg = -10 | .dh[0].max_deg = 10' "$ROBOT" > narrow.json
refused "${frame}the pose at .* mm: joint 1 would be at .* degrees, out of its range of -10 to 10" "$(robot narrow.json)"
jq '.bodies += [{name: "lamp", link: -1, shape: "sphere", centre: [1000, 930, 800], radius: 20}]' "$ROBOT" > lamp.json
refused "${frame}the pose at .* mm: spindle and lamp would collide, .* mm deep" "$(robot lamp.json)"
refused "${frame}the pose at .* mm: joint 2 would jump by 0.* degrees, from .* to " "$(robot "$ROBOT") --jump 0.05"
refused "${frame}the table would turn while the wheel grinds: it has to stand still" "$(robot "$SAMPLES/robots/irb1400_table.json") --table follow:20"
"$HERE/../refuses" "--track: expected auto, a number or follow:NUMBER, got 'nowhere'" fettle-gantry-robot "$ROBOT" plan.json --stock stock.stl --cell 0.2 --track nowhere

# Without --place the robot does not know where it is; a matrix that is none, and a machine that is no driver.
refuses() { "$HERE/../refuses" "$1" fettle-grind plan.json --stock stock.stl --cell 0.2 "${@:2}"; }
status=0
fettle-grind plan.json --stock stock.stl --cell 0.2 --gantry "exec:$(robot "$ROBOT")" > out 2> message || status=$?
[ $status = 2 ]
grep -q 'reports: the robot does not know where the job lies: no frame was given' message
printf '1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n' > mirror.txt
refuses 'mirror.txt: is a reflection' --gantry "exec:$(robot "$ROBOT")" --place mirror.txt
refuses '--place: goes with --gantry exec:COMMAND' --place place.txt
refuses 'none.txt: cannot open' --gantry "exec:$(robot "$ROBOT")" --place none.txt

# The driver's own inputs.
bad() { "$HERE/../refuses" "$1" fettle-gantry-robot "${@:2}" < /dev/null; }
bad 'job.json: ' "$ROBOT" job.json --stock stock.stl
bad 'plan.json: ' plan.json plan.json --stock stock.stl
bad 'none.json: cannot open' none.json plan.json --stock stock.stl
bad '--jump' "$ROBOT" plan.json --stock stock.stl --jump 0
jq '.region.x = [30, 60] | .anomalies = []' part.json | fettle-part > beside.stl
bad 'beside.stl: ' "$ROBOT" plan.json --stock beside.stl

# A session by keys, on a terminal of tmux: arrows lead the machine around the hill, r touches and keeps a corner, b takes it back; the
# screen shows sketch, fit and margin, then force, layer and time left; the space bar stops the machine in the middle, Enter goes on,
# and the terminal is left as it was. References: the screen; the plane.
# shellcheck source=tests/fettle-station/kit.bash
. "$HERE/kit.bash"
command -v tmux > /dev/null || { echo 'tmux is not installed' >&2; exit 77; }
make_job 0
make_stock 4
tmux() { command tmux -L "fettle-$$" -f /dev/null "$@"; }
trap 'tmux kill-server' EXIT
cat > run.sh << END
stty -g > before
fettle-station job.json --session session --stock stock.stl --cell 0.2 --lowest 0 --ascii \
    --gantry virtual:dynamic --machine $machine --pace 5 --report report.json
echo \$? > status
stty -g > after
sleep 60
END
tmux new-session -d -x 80 -y 24 -s station "bash run.sh 2>&1"
screen() { tmux capture-pane -p -t station; }
sees() { # TEXT…: waits until the screen has it
    local _
    for _ in {1..600}; do
        if screen | grep -qF -- "$1"; then return; fi
        sleep 0.05
    done
    echo "not on the screen: $1"
    screen
    exit 1
}
press() { # KEY TIMES: an arrow each 0.1 s of the machine
    local _
    for _ in $(seq "$2"); do
        tmux send-keys -t station "$1"
        sleep 0.08
    done
}
keep() { # COUNT: a corner around the anomaly; then there are so many
    tmux send-keys -t station r
    sees "points: $1 around the anomaly"
}
sees 'show the anomaly'
press Left 4
press Down 4
keep 1
press Right 8
keep 2
keep 3
tmux send-keys -t station b
sees 'points: 2 around the anomaly'
press Up 8
keep 3
press Left 8
keep 4
screen > shown.txt
for corner in 1 2 3 4; do grep -q $corner shown.txt; done
tmux send-keys -t station n
sees 'show what may be touched'
tmux send-keys -t station n
sees 'ENTER: touch'
tmux send-keys -t station Enter
sees 'raised by'
screen > review.txt
grep -q 'plane through 4 touches, rms' review.txt
grep -q 'error band' review.txt
grep -q '####' review.txt
tmux send-keys -t station Enter
sees 'left in this covering'
sees 'SPACE: stop'
sleep 2
screen > grinding.txt
grep -qE 'force [0-9.]+ of 15 N \[' grinding.txt
grep -qE 'layer [0-9]+ +pass [0-9]+ of [0-9]+' grinding.txt
tmux send-keys -t station Space
sees 'stopped by the operator'
sees 'ENTER: go on'
jq -e '.stage == "stopped" and (.stops | length) == 1 and (.stops[0] | .free - .asked <= 0.25)' session/session.json > ok
rows session/trace.pcd | awk '{ event = $7; z = $3 } END { exit !(event == 14 && z > 19.99) }'
stands=$(rows session/trace.pcd | tail -n 1)
sleep 1
[ "$(rows session/trace.pcd | tail -n 1)" = "$stands" ]
tmux send-keys -t station Enter
for _ in {1..1500}; do if screen | grep -q 'all is within tolerance'; then break; fi; sleep 0.1; done
sees 'all is within tolerance'
tmux send-keys -t station q
for _ in {1..100}; do [ -e after ] && break; sleep 0.05; done
[ "$(cat status)" = 0 ]
cmp before after
jq -e '.finished' report.json > ok
is_flat "$(jq .prediction.shift session/surface.json)" session/ground.pcd

# A terminal that goes away in the middle of the work stops the machine.
tmux kill-server
rm -rf session status after
sed -i 's/ --pace 5/ --pace 5 --steer \/dev\/tty/' run.sh
{ show; } > steer.txt
ends_with 1 station session steer.txt --gantry virtual:dynamic --machine "$machine"
sed -i 's/ --session session/ --session session --resume/' run.sh
tmux new-session -d -x 80 -y 24 -s station "bash run.sh 2>&1"
sees 'raised by'
tmux send-keys -t station Enter
sees 'left in this covering'
sleep 1
tmux kill-server
for _ in {1..100}; do if [ "$(jq -r .stage session/session.json)" = stopped ]; then break; fi; sleep 0.05; done
jq -e '.stage == "stopped"' session/session.json > ok
trap - EXIT

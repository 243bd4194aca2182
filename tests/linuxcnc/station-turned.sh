# A session with the wheel's axis at 20 degrees: B turned with it, touched, and ground to the end. The head is turned by a degree and back by
# the operator's keys, and stands at θ. References: the encoder of the C axis; the plane.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 20
jq '.safe_height = 10 | .anomaly |= map(. + [5])' job.json > settings.json
make_stock 1
fettle-stock-linuxcnc settings.json --stock stock.stl --cell 0.2 > before
start before
rm -f pipe
mkfifo pipe
fettle-station settings.json --session session --stock stock.stl --cell 0.2 --lowest 0 --ascii --gantry "exec:$(driver settings.json)" --steer pipe --report report.json &
station=$!
exec 3> pipe
axis() { inside halcmd getp joint.3.pos-fb; }
stands_at() { # DEGREES
    for _ in {1..400}; do
        if axis | awk -v at="$1" '{ exit !($1 > at - 0.01 && $1 < at + 0.01) }'; then return; fi
        sleep 0.05
    done
    echo "the C axis is at $(axis), not at $1"
    exit 1
}
echo '0 turn_left' >&3
stands_at 21
echo '0 turn_right' >&3
stands_at 20
printf '0 next\n0 next\n0 start\n0 start\n' >&3
exec 3>&-
wait $station
stands_at 20
jq -e '.finished' report.json
jq -e '.job.frame.theta_deg - 20 | fabs < 1e-9' session/session.json
stop
fettle-stock-linuxcnc settings.json --stock stock.stl --cell 0.2 --after machine/run/stock.ground --ascii > ground.pcd
# inside B, turned back by 20 degrees
awk -v shift_="$(jq .prediction.shift session/surface.json)" '/^DATA/ { body = 1; c = cos(atan2(0, -1) / 9); s = sin(atan2(0, -1) / 9); next }
    body { x = c * $1 + s * $2; y = c * $2 - s * $1; if (x > -5 && x < 5 && y > -5 && y < 5) { if ($3 > 5.12 + shift_ || $3 < 5 - 0.03) bad++; n++ } }
    END { print bad + 0 " of " n; exit bad > 0 || n < 2000 }' ground.pcd

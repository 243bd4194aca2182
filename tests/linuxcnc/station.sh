# A session on LinuxCNC: touched, ground, and stopped by a line of steering at 6 moments: each time the wheel is without force 0.25 s after
# the line was written, at the latest. Then the session's program is killed with -9 in the cut: the same, and --resume ends the work.
# References: every period of the servo thread; the plane.
# shellcheck source=tests/linuxcnc/machine.bash
. "$HERE/machine.bash"
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 0
jq '.safe_height = 10 | .anomaly |= map(. + [5])' job.json > settings.json
make_stock 2
fettle-stock-linuxcnc settings.json --stock stock.stl --cell 0.2 > before
start before
begin() { # OPTION…: steering comes through the pipe, file 3
    rm -f pipe
    mkfifo pipe
    fettle-station settings.json --session session --stock stock.stl --cell 0.2 --lowest 0 --ascii \
        --gantry "exec:$(driver settings.json)" --steer pipe --report report.json "$@" &
    station=$!
    exec 3> pipe
}
stage() { [ "$(jq -r .stage session/session.json 2> nothing)" = "$1" ]; }
wait_for() { # STAGE
    for _ in {1..1200}; do
        if stage "$1"; then return; fi
        sleep 0.05
    done
    echo "not $1 but $(jq -r .stage session/session.json)"
    exit 1
}
force() { inside halcmd gets force; }
in_cut() { # waits until the wheel is in the cut
    for _ in {1..2000}; do
        if force | awk '{ exit !($1 > 2) }'; then return; fi
        sleep 0.01
    done
    echo 'no force'
    exit 1
}
# The servo thread's record, as record() has it, and a mark that is set before a stop.
record_marked() {
    inside halcmd newsig mark bit
    inside halcmd loadrt sampler depth=20000 cfg=ffffb
    local pin=0
    for signal in x-at y-at z-at force mark; do
        inside halcmd net $signal sampler.0.pin.$pin
        pin=$((pin + 1))
    done
    inside halcmd addf sampler.0 servo-thread
    inside halsampler > record &
    recorder=$!
}
mark() { inside halcmd sets mark "$1"; }
begin
printf '0 next\n0 next\n0 start\n' >&3
wait_for review
record_marked
echo '0 start' >&3
RANDOM=1
for k in {1..6}; do
    in_cut
    sleep "0.0$((RANDOM % 10))" # the wheel is off the part between two passes: soon after contact, most moments are in the cut
    mark 1
    echo '0 stop' >&3
    wait_for stopped
    sleep 0.5
    mark 0
    [ "$k" = 6 ] || echo '0 start' >&3
done
echo '0 end' >&3
exec 3>&-
wait $station || [ $? = 1 ]
jq -c '.stops[] | [.asked, .free - .asked, .lifted - .free]' report.json
jq -e '.stage == "stopped" and (.stops | length) == 6' report.json > ok

# Killed in the cut.
begin --resume
echo '0 start' >&3
in_cut
mark 1
kill -9 $station
wait $station 2> nothing || true
exec 3>&-
sleep 1
end_record
# ms from the mark to the last force, the force at the mark; and the height at the end of the mark.
awk 'NF < 5 { next } $5 && !marked { from = NR; last = NR; f = $4 } $5 && $4 > 0 { last = NR } !$5 && marked { print last - from, f, z } { marked = $5; z = $3 }
    END { if (marked) print last - from, f, z }' record > times
awk '{ print $1 " ms, " $2 " N, then at z " $3; if ($1 > 250 || $3 < 9.9) bad = 1; cut += $2 > 0 } END { print NR " times"; exit bad || NR != 7 || cut < 4 }' times
begin --resume
echo '0 start' >&3
exec 3>&-
wait $station
jq -e '.finished' report.json
stop
fettle-stock-linuxcnc settings.json --stock stock.stl --cell 0.2 --after machine/run/stock.ground --ascii > ground.pcd
shift=$(jq .prediction.shift session/surface.json)
awk -v shift_="$shift" '/^DATA/ { body = 1; next } body && $1 > -5 && $1 < 5 && $2 > -5 && $2 < 5 { if ($3 > 5.12 + shift_ || $3 < 5 - 0.03) bad++; n++ }
    END { print bad + 0 " of " n; exit bad > 0 || n < 2000 }' ground.pcd

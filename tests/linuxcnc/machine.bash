# Sourced by the cases: a LinuxCNC of their own, in namespaces, that ends with them.
machine=$SAMPLES/machines/linuxcnc
skip() { echo "$1"; exit 77; }
command -v linuxcnc > /dev/null || skip 'linuxcnc-uspace is not installed'
command -v fettle-gantry-linuxcnc > /dev/null || skip 'built without linuxcnc-uspace-dev'
unshare --net --ipc --pid --mount --fork --kill-child --mount-proc true 2> /dev/null || skip 'namespaces are not allowed here'

# What is tested here are times: of the guard, of the stream of moves. They hold on a computer that runs. One that its host holds back for
# longer than a period of the client's heartbeat is no machine control: a case that fails on it is run again, and skipped after the third time.
if [ -z "${WATCHED:-}" ]; then
    for try in 1 2 3; do
        "$HERE/standstill" "$PWD/standstill" & # from before LinuxCNC is there until it has gone
        watch=$!
        mkdir "try-$try"
        status=0
        (cd "try-$try" && WATCHED=1 bash -euo pipefail "$0") || status=$?
        kill $watch
        wait $watch || true
        [ $status != 0 ] && [ $status != 77 ] && [ "$(cat standstill)" -gt 5 ] || exit $status
        echo "the computer stood still for $(cat standstill) ms"
    done
    exit 77
fi

start() { # STOCK: LinuxCNC in the folder machine/
    "$machine/start" machine "$1" || { cat machine/log; exit 1; }
    trap '[ -e machine/run/stop ] || "$machine/stop" machine' EXIT
}
stop() { "$machine/stop" machine; }
# What speaks to the realtime process does it from its own folders.
inside() {
    nsenter --target "$(cat machine/run/inner)" --mount --ipc --pid --wd="$PWD/machine" \
        env HOME="$PWD/machine/run" RTAPI_UID=65534 RTAPI_FIFO_PATH="$PWD/machine/run/fifo" "$@"
}
driver() { # PLAN: its command line
    echo "$machine/within $PWD/machine $(command -v fettle-gantry-linuxcnc) $(realpath "$1") --ini $PWD/machine/grind.ini"
}

# The servo thread's own record, a line each millisecond, in the file `record`: x y z mm, force N, the client's heartbeats,
# has the guard missed one, is the feed held.
record() {
    inside halcmd loadrt sampler depth=20000 cfg=ffffubb
    local pin=0
    for signal in x-at y-at z-at force client-beat lost held; do
        inside halcmd net $signal sampler.0.pin.$pin
        pin=$((pin + 1))
    done
    inside halcmd addf sampler.0 servo-thread
    inside halsampler > record &
    recorder=$!
}
end_record() {
    sleep 0.2 # what is on its way
    pkill -P $recorder halsampler || kill $recorder
    wait $recorder || true
    if grep -q overrun record; then echo 'the recorder was too slow'; exit 1; fi
}

# Talks to a driver line by line.
talk_to() { # PLAN
    # shellcheck disable=SC2046
    coproc DRIVER { exec $(driver "$1"); }
    n=0
    send 'connect fettle-gantry 1'
    send "limit $(jq 'if .kind == "plan" then .job else . end | .force.max * (if .units.force == "lbf" then 4.4482216152605 else 1 end)' "$1")"
    send "home $(jq 'if .kind == "plan" then .job else . end | (.frame.theta_deg // 0) * 3.141592653589793 / 180' "$1")"
}
send() { # COMMAND: its answer is in `answer`
    n=$((n + 1))
    printf '%s %s\n' $n "$1" >&"${DRIVER[1]}"
    read -r answer <&"${DRIVER[0]}"
    [[ $answer == "$n ok "* ]] || { echo "$1: $answer"; exit 1; }
}
kill_driver() { # PLAN: -9
    kill -9 "$(pgrep -f "^[^ ]*fettle-gantry-linuxcnc $(realpath "$1")")"
    wait "$DRIVER_PID" 2> /dev/null || true
}
# From the record, each time that the guard has missed a client: ms from its last heartbeat to the last motion or force; the force then, N.
stop_times() {
    awk '
        { if ($5 != beat) { beat = $5; beaten = NR; cut = $4 }
          if ($1 != x || $2 != y || $3 != z || $4 > 0) busy = NR
          x = $1; y = $2; z = $3
          if ($6 && !lost) { from = beaten; in_cut = cut; struck = 1 }
          lost = $6
          if (struck && NR - from == 500) { print busy - from, in_cut; struck = 0 } }' record
}

# Streams that end early or are none, for every tool: a closed stdout is a failed write, a pipe whose reader has ended gives no message, a
# terminal is no place to type points on, nor one for binary data, and an input that is a FIFO whose writer has ended is refused as a
# file that was cut off: within the bounds of probe.bash.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/tools.bash"
inputs
mkfifo early
for name in $names; do
    command_of "$name"
    elsewhere none nowhere
    side=("${named[@]:2*${#bulk[@]}}")
    status=0
    "fettle-$name" "${command[@]}" "${side[@]}" -q >&- 2>err <<<"$lines" || status=$?
    : >out
    [ ${#bulk[@]} = 0 ] || is_refusal $status stdout || say "status $status: $(cat err)" "$name with a closed stdout" # a driver's client has ended
    { "fettle-$name" "${command[@]}" "${side[@]}" -q 2>err <<<"$lines"; echo $? >status; } | head -c 1 >out || true
    case $(cat status) in 0 | 1 | 141) ;; *) say "status $(cat status)" "$name, a pipe that is closed" ;; esac
    [ ! -s err ] || say "a closed pipe: $(cat err)" "$name"
    tried=$((tried + 2))
    for ((i = 0; i < ${#command[@]}; i++)); do
        [ -f "${command[i]}" ] || continue
        words=("${command[@]}")
        words[i]=early
        case ${command[i]} in *.nc | *.txt) wish=S ;; *) wish=R ;; esac # a text of lines may end after any
        for part in 0 $(($(stat -c %s "${command[i]}") / 2)); do
            head -c "$part" "${command[i]}" >early &
            try $wish early timeout $((20 * ${FETTLE_PATIENCE:-1})) "fettle-$name" "${words[@]}" "${side[@]}" -q
            kill $! 2>killed || true
        done
    done
done
# On a terminal: nothing is waited for where points should come from, and nothing binary goes there.
on_terminal() { # WORD…: what it says is in `out`
    local status=0
    script -qec "stty -onlcr; $(printf '%q ' "$@")" /dev/null </dev/null >out 2>err || status=$?
    tried=$((tried + 1))
    [ $status = 2 ] && [ "$(wc -l <out)" = 1 ] && grep -q 'is a terminal' out || say "status $status: $(head -c 200 out)" "on a terminal $*"
}
for name in $names; do
    command_of "$name"
    "fettle-$name" --help | grep -q 'stdin if it is - or missing' || continue
    elsewhere none nowhere
    on_terminal timeout $((20 * ${FETTLE_PATIENCE:-1})) "fettle-$name" "${command[@]:0:${#command[@]}-1}" "${named[@]}"
done
on_terminal fettle-path work.pcd
on_terminal fettle-render good.pcd
on_terminal fettle-part part.json
all_tried 200

# A disk that is full, for every output of every tool, one at a time: the others can be written. The tool says so in one line that names the
# file, and leaves the folder as it was: an older file of that name with its contents, and nothing besides. First the system refuses from
# the first byte, then after 1 KiB.
# Written ahead, line by line, are --watch and the traces of machines: of them what could be written stays.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/tools.bash"
inputs
goes_ahead() { [[ "$name $1" == 'belt --watch' || "$name $1" == 'grind --trace' || "$name $1" == 'manual --trace' ]]; }
full() { # LIMIT OPTION PLACE: LIMIT is a command to run it by
    local option=$2 target=$3/-x-$2 status old says=-x-$2
    [ "$name" != station ] || says=': ' # what it keeps in the session's folder cannot be written either
    local older=('what was there')
    [ "$option" != -o ] || older+=('') # once will do
    [ "$option" != --journal ] || older=('') # what is there is read
    for old in "${older[@]}"; do
        [ -z "$old" ] || echo "$old" >"$target"
        elsewhere "$option" "$target"
        status=0
        "$1" "fettle-$name" "${command[@]}" "${named[@]}" -q 2>&1 >/dev/null <<<"$lines" | cat >err || status=${PIPESTATUS[0]}
        tried=$((tried + 1))
        is_refusal $status "$says" || say "status $status: $(head -c 200 err)" "$1 $option $name"
        goes_ahead "$option" || [ "$(ls -A "$3")" = "${old:+-x-$option}" ] || say "left: $(ls -A "$3" | tr '\n' ' ')" "$1 $option $name"
        goes_ahead "$option" || [ -z "$old" ] || [ "$(cat "$target")" = "$old" ] || say 'the older file is not as it was' "$1 $option $name"
        rm -f "$target"
    done
}
# What make coverage counts would be cut short, too.
uncounted() { export GCOV_PREFIX=/dev/null; }
nothing() { ( uncounted; ulimit -f 0; exec "$@" ); }
little() { ( uncounted; ulimit -f 1; exec "$@" ); }
mkdir place
: >out
for name in $names; do
    command_of "$name"
    for option in "${bulk[@]}" --report "${writes[@]}"; do full nothing "$option" place; done
done
for name in align mesh part render report; do
    command_of "$name"
    full little -o place
done
all_tried 100

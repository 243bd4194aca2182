# What a command line and its surroundings can do to every tool: options that are wrong, inputs that are none, "--" and strange names, and two
# files in one stream. Reference: the rules of every tool. Outputs and streams: tests/robustness.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/../robustness/tools.bash"
inputs
long=$(printf '%4096s' '' | tr ' ' a)
mkdir folder
: >out
for name in $names; do
    tool=fettle-$name
    command_of "$name"
    elsewhere none nowhere
    rest=("${command[@]}" "${named[@]:2*${#bulk[@]}}")
    option() { : >"./$1"; try R "./$1" "$tool" "${rest[@]}" "${@:2}"; } # the message names the option
    status=0
    "$tool" "${rest[@]}" -q >reference 2>err <<<"$lines" || status=$?
    [ $status -le 1 ] || say "status $status: $(cat err)" "$tool" "${rest[@]}"
    option --threads --threads 0
    option --threads --threads 1000000
    option --threads --threads
    option --threads --threads 1 --threads 2
    option --seed --seed x
    option --zebra --zebra
    # every option that takes a number, a word of a few or a list of them: nan is none; --avoid may occur alone
    while read -r name_of placeholder; do
        case $placeholder in FILE | FOLDER | LAW | PART | SCAN | STOCK | SURFELS | SURFACE* | MESH | JOB | POINTS | PATH | TRACE | EVENTS | TEXT | NAME) continue ;; esac
        case " ${command[*]} --threads --seed --avoid " in *" $name_of "*) continue ;; esac
        option "$name_of" "$name_of" nan
    done < <("$tool" --help | sed -nE 's/^ +(-[a-z],)?(--[a-z0-9-]+) ([^ =]+).*/\2 \3/p')
    rm ./--*
    # none of the inputs is what it should be
    for ((i = 0; i < ${#command[@]}; i++)); do
        [ -f "${command[i]}" ] || continue
        for file in folder missing "$long"; do
            words=("${rest[@]}")
            words[i]=$file
            status=0
            "$tool" "${words[@]}" >out 2>err </dev/null || status=$?
            is_refusal $status "${file:0:20}" || say "$status, $(head -c 200 err)" "$tool" "${command[i]}" "${file:0:20}"
            tried=$((tried + 1))
        done
    done
    # after "--" a name may begin with a dash
    last=$((${#command[@]} - 1))
    [ -f "${command[last]}" ] && [ "$name" != report ] || continue
    cp "${command[last]}" ./-x
    "$tool" "${command[@]:0:last}" "${rest[@]:last+1}" -q -- -x >out 2>err <<<"$lines" || say "$(cat err)" "$tool -- -x"
    case $name in diff | view) ;; *) cmp -s reference out || say 'not the same after --' "$tool" ;; esac # these say the names
    rm ./-x
    tried=$((tried + 1))
done
# Two point files one after the other on stdin, text and binary mixed.
for name in align arm assess belt collide compare contact estimate feed fit form path render; do
    command_of $name
    elsewhere none nowhere
    for second in good.pcd work.pcd; do
        status=0
        cat "${command[-1]}" $second | "fettle-$name" "${command[@]:0:${#command[@]}-1}" "${named[@]:2}" >out 2>err || status=$?
        is_refusal $status stdin || say "$status: $(head -c 200 err)" "two files, fettle-$name"
        tried=$((tried + 1))
    done
done
all_tried 550

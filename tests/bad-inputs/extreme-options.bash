# Every option that takes a number, or a list of them, with numbers at the ends of what can be written: an answer or a refusal in one
# line, within bounds of time and memory. Every option is also given a number that it takes, so that none is refused for its company alone.
# Reference: the rules of every tool, and its --help. Two cases share the tools: `half`, 0 or 1, takes every other one.
# shellcheck shell=bash
# shellcheck source=tests/robustness/tools.bash
. "$HERE/../robustness/tools.bash"
inputs
kTime=$((20 * ${FETTLE_PATIENCE:-1})) # s: what waits for a processor takes longer than the 10 s it may have of one
kMemory=2000000 # KiB of addresses: libraries and two threads reserve less than half
# With FETTLE_DRAWS=few (make test) each option gets one of the ends, another one than its neighbour, and with each FETTLE_SEED, a number, another.
turn=${FETTLE_SEED:-0}
place=0
values=(0 -1 1e-300 1e300 1e15 1e-9 nan inf '')
ordinary=(5 20 1 0.5 300)

# The command in which an option counts, where that of tools.bash is not one.
company_of() { # NAME OPTION: changes `command`
    case "$1 $2" in
    'arm --joint-speed') command=(robot.json --inverse --feed 50 --unchecked --krl program.src tips.pcd) ;;
    'arm --box' | 'arm --step') command=(robot.json --reach --box 700,0,500,720,20,520) ;;
    *' --table') command[0]=$SAMPLES/robots/irb1400_table.json ;;
    'calibrate --cell')
        awk 'BEGIN { for (x = 0; x <= 30; x += 0.5) for (y = 0; y <= 30; y += 0.5) print x, y, 8 }' >high.xyz # several layers
        [ -e cut.pcd ] || fettle-grind plan.json --stock high.xyz --cell 0.5 --gantry virtual --trace cut.pcd -q >ground.pcd
        command=(cut.pcd --job job.json --before high.xyz)
        ;;
    'collide --max-t'* | 'collide --max-r'*) command+=(--avoid) ;;
    'collide --cell') command+=(--method grid) ;;
    'collide --at' | 'collide --from') command+=(--picture picture.png) ;;
    'compare --direction') command+=(--mode direction) ;;
    'compare --bins') command+=(--histogram histogram.csv) ;;
    'contact --depth' | 'feed --depth') without --force ;;
    'feed --lower') command+=(--upper 1000) ;;
    'feed --upper') command+=(--lower -1) ;;
    'belt --depth') without --force && command+=(--watch watch.csv) ;;
    'belt '*) command+=(--watch watch.csv) ;; # --lower and --upper are for it
    'contact --elements') command+=(--solver fem --cells 8) ;;
    'finish --scallop') without --step-over ;;
    'verify --feed' | 'verify --cutter' | 'verify --axis') command+=(--corrected corrected.nc) ;;
    'verify '*) command=(--design plate.stl --step 4 plate.stl) ;;
    'teach --direction') command+=(--surface swept) ;;
    'place --threshold') command=(--up plane good.pcd) ;;
    'form '*) command=(straightness --sections 5 good.pcd) ;;
    'mesh --step') command=(surface.json --within job.json) ;;
    'mill --tolerance') without --step ;;
    'mill --feed') command=(--stock box:0,0,0,9,9,9 --cutter ball:6 --step 0.5 path.xyz) ;;
    'path --approach') command+=(--clearance 5) ;;
    'path --wheel') command+=(--held part) ;;
    'station '*)
        rm -rf session
        command+=(--session session)
        ;;&
    'station --direction') command+=(--surface swept) ;;
    'station --patience') command=(--gantry 'exec:fettle-gantry-virtual job.json --stock good.pcd --cell 0.5' --lowest 0 --steer operator.txt --resume --session session job.json) ;;
    'sample --max-touches') command+=(--strategy adaptive) ;;
    'sample --touches' | 'sample --candidates' | 'sample --mutations' | 'sample --sharpness') command+=(--strategy hillclimb --mutations 20 --candidates 3) ;;
    esac
}

without() { # OPTION: takes it and its value out of `command`
    local words=() i
    for ((i = 0; i < ${#command[@]}; i++)); do
        if [ "${command[i]}" = "$1" ]; then i=$((i + 1)); else words+=("${command[i]}"); fi
    done
    command=("${words[@]}")
}

word_of() { # PLACEHOLDER VALUE: into `word`
    case $1 in
    CUTTER) word=ball:$2 ;;
    STOCK) [ "$2" = 5 ] && word=box:0,0,0,9,9,9 || word=box:0,0,0,$2,$2,$2 ;;
    AXIS,DEG,...) word=x,$2 ;;
    REGION) word=sphere:15,15,5,$2 ;;
    FILTER) word=radius:$2,1 ;;
    uniform:A\|normal:A) word=normal:$2 ;;
    %) word=$2 ;;
    X,Y,Z,QW*) [ "$2" = 5 ] && word=15,15,5,1,0,0,0 || word=$2,$2,$2,$2,$2,$2,$2 ;;
    DEG,...) word=$2,$2,$2,$2,$2,$2 ;;
    *) word=$(sed -E "s/[A-Z][A-Z0-9]*/$2/g; s|/$2||; s/,\.\.\.//" <<<"$1") ;;
    esac
    [ -n "$2" ] || word=
}

within_bounds() { # COMMAND…: sets `status`; complains of anything but an answer or a refusal
    local lines_of_err
    status=0
    tried=$((tried + 1))
    (ulimit -v $kMemory -t 10; exec timeout $kTime "$@") >out 2>err <<<"$lines" || status=$?
    mapfile lines_of_err <err
    case $status in
    # A machine's fault is said, with -q too.
    0 | 1) [ ${#lines_of_err[@]} = 0 ] || [[ $status = 1 && ${#lines_of_err[@]} = 1 && ${lines_of_err[0]} == *'; stopped'* ]] || say "status $status with ${lines_of_err[*]}" "$@" ;;
    2)
        if [ ${#lines_of_err[@]} != 1 ] || [ -s out ]; then say "refused in ${#lines_of_err[@]} lines, $(stat -c %s out) bytes on stdout" "$@"
        elif [[ ${lines_of_err[0]} == *'out of memory'* || ${lines_of_err[0]} == *'internal error'* ]]; then say "${lines_of_err[0]%$'\n'}" "$@"
        fi ;;
    *) say "status $status $(head -c 200 err)" "$@" ;;
    esac
}

for name in $names; do
    place=$((place + 1))
    [ $((place % 2)) = "$half" ] || continue
    tool=fettle-$name
    while IFS='= ' read -r option placeholder default; do
        case $placeholder in FILE | FOLDER | LAW | DEVICE | PART | SCAN | REF | ROW* | SURFELS | SURFACE* | MESH | JOB | POINTS | PATH | TRACE | EVENTS | TEXT | NAME | NAME,... | LINK | LIST | AXES | RULE | exec:*) continue ;; esac
        [ "$name $option" != 'station --pace' ] || continue # it makes a simulated machine wait
        case $option:$placeholder in --threads:* | --seed:*) continue ;; *:uniform:A*) ;; *\|*) continue ;; esac # command-line.sh has them
        command_of "$name"
        elsewhere none nowhere
        company_of "$name" "$option"
        without "$option"
        taken=
        why=
        turn=$((turn + 1))
        ends=("${values[@]}")
        [ "${FETTLE_DRAWS:-all}" = all ] || ends=("${values[turn % 9]}")
        for value in "${ordinary[@]}" "${values[@]}"; do
            [ -z "$taken" ] || [[ " ${ends[*]} " == *" $value "* ]] || continue # all others, until one is taken
            [ "$value" != "$default" ] || [ -z "$value" ] || continue # what all other cases use
            word_of "$placeholder" "$value"
            within_bounds "$tool" -q --threads 2 "${named[@]:0:2*${#bulk[@]}}" "${command[@]}" "$option=$word"
            [ $status -gt 1 ] || taken=1
            why=${why:-$(<err)}
        done
        [ -n "$taken" ] || [ "$name $option" = 'path --patch' ] || say 'takes none of the numbers' "$tool $option ($why)" # the workpiece has one patch, the default's
    done < <("$tool" --help | sed -nE 's/^ +(-[a-z],)?(--[a-z0-9-]+) ([^ ]+).*/\2 \3/p')
done
[ "${FETTLE_DRAWS:-all}" = all ] && all_tried 500 || all_tried 125

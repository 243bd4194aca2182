# What a command line and its surroundings can do to every tool that writes to stdout. Reference: the rules of every tool.
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
cp "$SAMPLES/parts/hill.json" part.json
fettle-surfel plate.stl --stock plate.stl --spacing 4 -q -o work.pcd
tool() { # NAME: its command, with the last of its inputs last
    case $1 in
    align) echo --to plate.stl --near good.pcd ;;
    arm) echo robot.json --inverse good.pcd ;;
    assess) echo --lower -1 --upper 1 good.pcd ;;
    belt) echo --path good.pcd --wheel wheel.json --force 5 good.pcd ;;
    collide) echo robot.json good.pcd ;;
    compare) echo --to plate.stl good.pcd ;;
    contact) echo --wheel wheel.json --at 15,15,5,1,0,0,0 --force 5 good.pcd ;;
    diff) echo good.pcd good.pcd ;;
    estimate) echo job.json samples.pcd ;;
    finish) echo --cutter ball:6 --step-over 4 plate.stl ;;
    fit) echo job.json samples.pcd ;;
    form) echo flatness good.pcd ;;
    grind) echo --stock good.pcd --cell 0.5 plan.json ;;
    margin) echo job.json fit.json ;;
    mesh) echo --at good.pcd surface.json ;;
    mill) echo --stock box:0,0,0,9,9,9 --cutter ball:6 --step 0.5 path.nc ;;
    part) echo part.json ;;
    path) echo work.pcd ;;
    plan) echo job.json surface.json ;;
    render) echo good.pcd ;;
    report) echo --job job.json ;;
    sample) echo --on good.pcd job.json ;;
    surfel) echo --stock plate.stl --spacing 4 plate.stl ;;
    verify) echo --design plate.stl --step 4 plate.stl ;;
    esac
}
names='align arm assess belt collide compare contact diff estimate finish fit form grind margin mesh mill part path plan render report sample surfel verify'
long=$(printf '%4096s' '' | tr ' ' a)
mkdir folder read-only
chmod 555 read-only
check() { # MESSAGE COMMAND…
    "${@:2}" || say "$1" "${@:2}"
}
quiet() { "$@" >/dev/null 2>&1; }
for name in $names; do
    tool=fettle-$name
    read -ra rest < <(tool "$name")
    last=${rest[-1]}
    first=("${rest[@]:0:${#rest[@]}-1}")
    here() { try R "$1" "$tool" "${@:2}"; } # the message names the file or the option
    option() { : >"./$1"; try R "./$1" "$tool" "${rest[@]}" "${@:2}"; rm "./$1"; }
    status=0
    "$tool" "${rest[@]}" -q >reference 2>err || status=$?
    [ $status -le 1 ] || say "status $status: $(cat err)" "$tool" "${rest[@]}"
    option --threads --threads 0
    option --threads --threads 1000000
    option --threads --threads
    option --threads --threads 1 --threads 2
    option --seed --seed x
    option --zebra --zebra
    for file in folder missing "$long"; do
        status=0
        "$tool" "${first[@]}" "$file" >out 2>err </dev/null || status=$?
        [ $status = 2 ] && [ ! -s out ] && [ "$(wc -l <err)" = 1 ] || say "$status, $(head -c 200 err)" "$tool" "${first[@]}" "${file:0:20}"
    done
    for output in missing/out read-only/out /dev/full folder; do
        [ "$output" != read-only/out ] || [ "$(id -u)" != 0 ] || continue # root may write there
        status=0
        "$tool" "${rest[@]}" -q -o "$output" >out 2>err </dev/null || status=$?
        [ $status = 2 ] && [ ! -s out ] && [ "$(wc -l <err)" = 1 ] && grep -qF "$output" err || say "$status, $(head -c 200 err)" "$tool" "${rest[@]}" -o "$output"
        tried=$((tried + 1))
    done
    [ -z "$(ls folder)" ] || say 'left something in folder' "$tool"
    # the same with --, with a file called -x, without a home, with decimal commas; nothing goes to a closed stdout, and a closed pipe is quiet
    same() { cmp -s reference out || say "not the same: $1" "$tool"; tried=$((tried + 1)); }
    if [ "$name" != report ]; then
        cp "$last" ./-x
        "$tool" "${first[@]}" -q -- -x >out 2>/dev/null || true
        [ "$name" = diff ] || same --
        rm ./-x
    fi
    env -i PATH="$PATH" LC_ALL=de_DE.UTF-8 LC_NUMERIC=de_DE.UTF-8 "$tool" "${rest[@]}" -q >out 2>/dev/null || true
    same 'no home, decimal commas'
    status=0
    "$tool" "${rest[@]}" -q >&- 2>err || status=$?
    [ "$name" = diff ] || [ $status = 2 ] || say "status $status with a closed stdout" "$tool"
    { "$tool" "${rest[@]}" -q 2>err || true; } | head -c 1 >/dev/null || true
    [ ! -s err ] || say "a closed pipe: $(cat err)" "$tool"
    # output = input
    cp "$last" copy
    status=0
    "$tool" "${first[@]}" copy -q -o copy >out 2>err || status=$?
    if [ "$name" != report ] && [ "$name" != diff ] && [ $status -le 1 ]; then cp copy out; same 'output = input'; fi
done
# Two point files one after the other on stdin, text and binary mixed.
fettle-form flatness good.pcd -q -o /dev/null
for name in align arm assess belt collide compare contact estimate fit form path render; do
    read -ra rest < <(tool $name)
    for second in good.pcd work.pcd; do
        status=0
        cat "${rest[-1]}" $second | "fettle-$name" "${rest[@]:0:${#rest[@]}-1}" >out 2>err || status=$?
        [ $status = 2 ] && [ ! -s out ] && [ "$(wc -l <err)" = 1 ] || say "$status: $(head -c 200 err)" "two files, fettle-$name"
        tried=$((tried + 1))
    done
done
all_tried 300

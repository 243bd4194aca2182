# A good command for every tool: what it reads, and all that it can write. To be sourced by the cases; tests/robustness/table.sh
# asserts that no tool and no option that names a file is left out.
#
#   inputs [STEP]    makes the files that the commands read, with points so many mm apart [3]
#   for name in $names; do command_of NAME; …
#                    command   its words, without outputs; the last is the input that may come from stdin, if it has one
#                    bulk      -o; nothing if stdout is a conversation
#                    writes    options that name an output each, besides -o and --report; --session and --frames-in name a folder
#                    lines     lines on its stdin
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/../bad-inputs/probe.bash"

# fettle-gantry-linuxcnc is for a machine that runs: tests/linuxcnc.
names='align arm assess belt calibrate clean collide compare contact diff estimate feed find finish fit form gantry-robot gantry-virtual grind manual margin merge mesh mill part path place
    plan reconstruct render report sample station stock-linuxcnc surfel teach verify view'
if command -v fettle-step > /dev/null; then names+=' step'; fi # built where OpenCASCADE is

inputs() { # STEP
    good "$@"
    echo '{"kind": "part", "units": {"length": "mm"}, "surface": {"type": "plane", "point": [0, 0, 5]}, "region": {"x": [-20, 20], "y": [-20, 20]},
        "step": 1, "anomalies": [{"type": "hill", "centre": [0, 0], "semi_axes": [4, 3], "height": 1}]}' >part.json
    fettle-surfel plate.stl --stock plate.stl --spacing 4 -q -o work.pcd
    awk 'BEGIN { for (i = 0; i < 9; i++) print 10 + 2 * i, 10, 5 }' | rows | pcd "$kFields" >rows.pcd
    cp "$SAMPLES/paths/keel.pcd" tips.pcd
    fettle-calibrate "$SAMPLES/removal/static.csv" -q >law.json
    printf '0 0 1 up\n0.1 0 -1\n0.4 end\n' >steer.txt
    printf '0 next\n0 next\n0 start\n0 manual\n0 start\n100 1 0\n100.2 end\n' >operator.txt
    printf '10,10,5\n20,10,5\n20,20,5\n10,20,5\n' >picked.txt
}

command_of() { # NAME
    writes=()
    bulk=(-o)
    lines=
    case $1 in
    align) command=(--to plate.stl --near good.pcd) writes=(--transform-out) ;;
    arm) command=(robot.json --inverse --feed 50 --unchecked tips.pcd) writes=(--rapid --krl --ls --urscript) ;;
    assess) command=(--lower -1 --upper 1 good.pcd) ;;
    belt) command=(--path rows.pcd --wheel wheel.json --actual wheel.json --force 5 --lower -1 --upper 1 work.pcd) writes=(--trace --watch --journal --frames-in) ;;
    calibrate) command=(--wheel wheel.json --known law.json "$SAMPLES/removal/static.csv") ;;
    clean) command=(--outliers statistical:4,3 --thin 1 good.pcd) ;;
    find) command=(--against plate.stl --transform-in identity.txt good.pcd) writes=(--transform-out) ;;
    collide) command=(robot.json --workpiece plate.stl tips.pcd) writes=(--picture --chart) ;;
    compare) command=(--to plate.stl good.pcd) writes=(--reverse --csv --histogram) ;;
    contact) command=(--wheel wheel.json --at 15,15,5,1,0,0,0 --force 5 work.pcd) ;;
    diff) command=(good.pcd good.pcd) ;;
    estimate) command=(job.json samples.pcd) ;;
    feed) command=(--on work.pcd --wheel wheel.json --force 5 --cells 8 --rounds 1 rows.pcd) ;;
    finish) command=(--cutter ball:6 --step-over 4 plate.stl) ;;
    fit) command=(job.json samples.pcd) ;;
    form) command=(flatness good.pcd) ;;
    gantry-robot) command=(robot.json --stock good.pcd --cell 0.5 plan.json) bulk=() writes=(--ground --moves) lines='1 status' ;;
    gantry-virtual) command=(--stock good.pcd --cell 0.5 --machine machine.json plan.json) bulk=() writes=(--ground) lines='1 status' ;;
    grind) command=(--stock good.pcd --cell 0.5 --gantry virtual:dynamic --machine machine.json plan.json) writes=(--trace --frames-in) ;;
    manual) command=(--stock good.pcd --cell 0.5 --machine machine.json --steer steer.txt job.json) writes=(--trace) ;;
    margin) command=(job.json fit.json) ;;
    merge) command=(--file-units mm "$SAMPLES/scans/views/2.pcd" "$SAMPLES/scans/views/3.pcd") ;;
    mesh) command=(--at good.pcd surface.json) ;;
    mill) command=(--stock box:0,0,0,9,9,9 --cutter ball:6 --step 0.5 path.nc) writes=(--trace --frames-in) ;;
    part) command=(part.json) ;;
    path) command=(work.pcd) ;;
    place) command=(--up plane --centre good.pcd) writes=(--transform-out --inverse) ;;
    plan) command=(job.json surface.json) writes=(--path) ;;
    reconstruct) command=(good.pcd) ;;
    render) command=(good.pcd) ;;
    report) command=(--job job.json --samples samples.pcd --errors good.pcd) ;;
    sample) command=(--on good.pcd job.json) ;;
    station) command=(--gantry virtual:dynamic --machine machine.json --stock good.pcd --cell 0.5 --lowest 0 --steer operator.txt --resume job.json) bulk=() writes=(--session) ;;
    stock-linuxcnc) command=(--stock good.pcd --cell 0.5 plan.json) ;;
    step) command=(--tolerance 0.5 "$SAMPLES/designs/clamp.step") ;;
    surfel) command=(--stock plate.stl --spacing 4 plate.stl) ;;
    teach) command=(--anomaly picked.txt job.json) ;;
    verify) command=(--design plate.stl --step 4 --correct path.nc --cutter ball:6 plate.stl) writes=(--csv --z-errors --corrected) ;;
    view) command=(good.pcd) ;;
    *) return 1 ;;
    esac
}

# Every output of the tool at hand in a folder of its own, named by its option.
outputs() { # FOLDER: into `named`
    local option
    mkdir -p "$1"
    named=()
    for option in "${bulk[@]}" --report "${writes[@]}"; do
        [ "$option" != --frames-in ] || named+=(--frames 3)
        named+=("$option" "$1/$option")
    done
}

# All outputs to nowhere, but for one that goes to PLACE; without a journal, which would be read, and pictures.
elsewhere() { # OPTION PLACE: into `named`
    local option
    named=()
    for option in "${bulk[@]}" --report "${writes[@]}"; do
        if [ "$option" = "$1" ]; then
            [ "$option" != --frames-in ] || named+=(--frames 3)
            named+=("$option" "$2")
        elif [ "$option" = --session ]; then named+=("$option" "$(mktemp -d -p .)")
        elif [ "$option" != --journal ] && [ "$option" != --frames-in ]; then named+=("$option" /dev/null); fi
    done
}

# A refusal: status 2, one line on stderr that has the text in it, nothing on stdout. By builtins, as `try`.
is_refusal() { # STATUS TEXT
    local lines
    mapfile lines <err
    [ "$1" = 2 ] && [ ! -s out ] && [ ${#lines[@]} = 1 ] && [[ ${lines[0]} == *"$2"*$'\n' ]]
}

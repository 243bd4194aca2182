# What every tool is tried with: bad files in every place where it reads one. To be sourced by the cases.
#
#   good [STEP]               makes good files for all the other places
#   try R|S|G NAME COMMAND…   runs a command that reads the file NAME.
#                             R: it must be refused: status 2, one line on stderr that names the file, nothing on stdout.
#                             T: it must be refused so, or read as far as it goes: status 0, and a warning that names the file.
#                             S: it may be read: status 0 or 1; or it is refused, though not for the file as such.
#                             G: it is good: status 0 or 1.
#   all_tried                 fails if a try has, or if there were fewer than MIN_COUNT
#
# With FETTLE_DRAWS=few (make test) an eighth of the bad files' tries is made: drawn, so that over the files of a case each place has some.
# FETTLE_SEED, a number, draws another.
#
# In all cases: no signal, at most 10 s of processor time, and no more memory than the tool itself needs and ten times the file, of a large one three times.
kOwnMemory=250000 # KiB: libraries and their threads; PCL and OpenCV alone map half of it
tried=0
left=0 # to make test-all
failed=0
RANDOM=${FETTLE_SEED:-1}

say() {
    failed=$((failed + 1))
    [ $failed -gt 40 ] || printf '%s\n' "$1: ${*:2}" >&2
}

# Uses builtins of bash where possible: it is called thousands of times.
try() {
    local wish=$1 file=$2 status=0 memory max_memory lines
    shift 2
    if [ "${FETTLE_DRAWS:-all}" != all ] && [ "$wish" != G ] && [ $((RANDOM % 8)) != 0 ]; then
        left=$((left + 1))
        return
    fi
    tried=$((tried + 1))
    ( ulimit -t 10; exec /usr/bin/time -q -o rss -f '%M' "$@" ) >out 2>err </dev/null || status=$?
    read -r memory <rss
    mapfile lines <err
    max_memory=$kOwnMemory
    [ "$memory" -le $max_memory ] || max_memory=$(stat -Lc %s "$file" | awk -v own=$max_memory '{ print int(own + ($1 > 10000000 ? 3 : 10) * $1 / 1024) }')
    if [ $status -gt 2 ]; then
        say "status $status" "$@"
    elif [ "$memory" -gt "$max_memory" ]; then
        say "$memory KiB" "$@"
    elif [ $status = 2 ]; then
        if [ "$wish" = G ]; then say "refused: ${lines[*]}" "$@"
        elif [ -s out ]; then say "refused, with $(stat -c %s out) bytes on stdout" "$@"
        elif [ ${#lines[@]} != 1 ] || [[ ${lines[0]} != *$'\n' ]]; then say "refused in ${#lines[@]} lines: ${lines[*]:0:2}" "$@"
        elif [[ ${lines[0]} == *'out of memory'* ]]; then say 'out of memory' "$@"
        elif [ "$wish" != S ] && [[ ${lines[0]} != *"${file##*/}"* ]]; then say "does not name ${file##*/}: ${lines[0]}" "$@"
        fi
    elif [ "$wish" = T ]; then
        [[ ${lines[*]} == *"warning: ${file##*/}: "* ]] || say "status $status, expected a refusal or a warning" "$@"
    elif [ "$wish" = R ]; then
        say "status $status, expected a refusal" "$@"
    fi
}

all_tried() { # MIN_COUNT
    echo "$tried tried, $failed failed, $left left to make test-all"
    [ $failed = 0 ] && [ $((tried + left)) -ge "$1" ]
}

pcd() { # FIELDS < rows: an ASCII PCD, mm
    local rows
    rows=$(cat)
    printf '# .PCD v0.7\n# units mm\nVERSION 0.7\nFIELDS %s\nSIZE %s\nTYPE %s\nCOUNT %s\nWIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n%s\n' "$1" \
        "$(sed 's/[^ ][^ ]*/4/g' <<<"$1")" "$(sed 's/[^ ][^ ]*/F/g' <<<"$1")" "$(sed 's/[^ ][^ ]*/1/g' <<<"$1")" "$(wc -l <<<"$rows")" "$(wc -l <<<"$rows")" "$rows"
}

# All fields that some tool requires of a point.
kFields='x y z normal_x normal_y normal_z qw qx qy qz role curve error displacement radius t layer pass event force feed joint1 joint2 joint3 joint4 joint5 joint6 joint7'
rows() { # < x y z a line: with values for the other fields
    awk '{ print $0, "0 0 1 1 0 0 0", NR % 2 + 1, NR % 4, 0.01, 0.02, 0.5, NR, 1, 1, 0, 5, 10, "0 0 0 0 0 0 0" }'
}

good() { # STEP: mm between points [3]
    cp -r "$SAMPLES/robots/irb1400.json" robot.json
    cp "$SAMPLES/machines/full_scale.json" machine.json
    cp "$SAMPLES/wheels/rubber_preston.json" wheel.json
    echo '{"kind": "job", "units": {"length": "mm", "force": "N"}, "surface": {"type": "freeform"}, "safe_height": 30,
        "anomaly": [[10, 10, 5], [20, 10, 5], [20, 20, 5], [10, 20, 5]], "sampling": [[2, 2, 5], [28, 2, 5], [28, 28, 5], [2, 28, 5]],
        "wheel": {"radius": 10, "width": 5, "min_radius": 5}, "feed": {"rate": 20, "step_over": 4}, "force": {"min": 20, "max": 60, "stiffness": 35}}' >job.json
    echo '{"kind": "surface", "units": {"length": "mm"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 5, "slope": [0, 0]}}' >surface.json
    awk -v step="${1:-3}" 'BEGIN { n = int(30 / step + 0.5); for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) print i * step, j * step, 5 + (i * 2 == n && j * 2 == n) * 0.2 }' | rows | pcd "$kFields" >good.pcd
    fettle-sample job.json --on good.pcd >samples.pcd
    fettle-fit job.json samples.pcd >fit.json
    fettle-plan job.json surface.json >plan.json
    { echo 'solid plate'; facet 0 0 5 40 0 5 40 40 5; facet 0 0 5 40 40 5 0 40 5; echo 'endsolid plate'; } >plate.stl
    printf '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' >identity.txt
    printf '0 0 5\n9 9 5\n' >path.xyz
    printf 'G21 G90\nG0 X0 Y0 Z9\nF100\nG1 Z4\nX9\nM30\n' >path.nc
}
facet() { printf 'facet normal 0 0 1\nouter loop\nvertex %s %s %s\nvertex %s %s %s\nvertex %s %s %s\nendloop\nendfacet\n' "$@"; }

# Every tool that reads points, with FILE in each place where it does.
points() { # R|S FILE
    try "$1" "$2" fettle-align "$2" --to plate.stl --near
    try "$1" "$2" fettle-align good.pcd --to "$2" --near
    try "$1" "$2" fettle-arm robot.json --inverse "$2"
    try "$1" "$2" fettle-arm robot.json --forward "$2"
    try "$1" "$2" fettle-assess "$2" --lower -1 --upper 1
    try "$1" "$2" fettle-belt "$2" --path good.pcd --wheel wheel.json --force 5
    try "$1" "$2" fettle-belt good.pcd --path "$2" --wheel wheel.json --force 5
    try "$1" "$2" fettle-clean "$2" --outliers statistical:2,3 --thin 1
    try "$1" "$2" fettle-collide robot.json "$2"
    try "$1" "$2" fettle-compare "$2" --to plate.stl
    try "$1" "$2" fettle-compare good.pcd --to "$2"
    try "$1" "$2" fettle-contact "$2" --wheel wheel.json --at 15,15,5,1,0,0,0 --force 5
    try "$1" "$2" fettle-diff "$2" good.pcd
    try "$1" "$2" fettle-diff good.pcd "$2"
    if [ "$1" != S ]; then # it works long on what it can read, and reads as fettle-belt does
        try "$1" "$2" fettle-feed good.pcd --on "$2" --wheel wheel.json --force 5 --cells 8 --rounds 1
        try "$1" "$2" fettle-feed "$2" --on good.pcd --wheel wheel.json --force 5 --cells 8 --rounds 1
    fi
    try "${1/G/S}" "$2" fettle-estimate job.json "$2"
    try "$1" "$2" fettle-fit job.json "$2"
    try "${1/G/S}" "$2" fettle-find "$2"
    try "$1" "$2" fettle-form flatness "$2"
    try "$1" "$2" fettle-form sphericity "$2"
    try "$1" "$2" fettle-grind plan.json --stock "$2" --cell 2
    stocks "$@"
    try "${1/G/S}" "$2" fettle-margin job.json fit.json --scan "$2"
    try "${1/G/S}" "$2" fettle-merge "$2" good.pcd
    try "$1" "$2" fettle-mesh surface.json --at "$2"
    try "$1" "$2" fettle-mill "$2" --stock box:0,0,0,9,9,9 --cutter ball:6 --step 0.5
    try "$1" "$2" fettle-mill path.nc --stock "$2" --cutter ball:6 --step 0.5
    try "$1" "$2" fettle-path "$2"
    try "$1" "$2" fettle-place "$2" --turn x,30
    try "${1/G/S}" "$2" fettle-reconstruct "$2"
    try "$1" "$2" fettle-render "$2"
    try "$1" "$2" fettle-report --errors "$2"
    try "${1/R/T}" "$2" fettle-report --trace "$2" # a trace may be one of a killed run
    try "$1" "$2" fettle-report --job job.json --samples "$2"
    try "$1" "$2" fettle-sample job.json --on "$2"
    try "$1" "$2" fettle-surfel "$2" --stock plate.stl
    try "$1" "$2" fettle-surfel plate.stl --stock "$2"
    try "$1" "$2" fettle-view "$2"
    jq -n --arg file "$PWD/$2" '{kind: "part", units: {length: "mm"}, scan: {file: $file, units: "mm"}, region: {x: [5, 25], y: [5, 25]}, step: 1, anomalies: []}' >spec.json
    try "$1" "$2" fettle-part spec.json
}

# FILE as the stock of machines that end at once: stdin is empty.
stocks() { # R|S|G FILE
    try "$1" "$2" fettle-gantry-virtual plan.json --stock "$2" --cell 2
    try "$1" "$2" fettle-manual job.json --stock "$2" --cell 2 --machine machine.json --steer -
    try "$1" "$2" fettle-gantry-robot robot.json plan.json --stock "$2" --cell 2
    try "$1" "$2" fettle-stock-linuxcnc plan.json --stock "$2" --cell 2
    [ "$1" != R ] || try R "$2" fettle-teach job.json --gantry virtual --stock "$2" --steer - # without points there is no job
    try "$1" "$2" fettle-station job.json --session "session-$tried" --gantry virtual --stock "$2" --cell 2 --steer -
}

# Every tool that reads meshes, with FILE in each place where it does.
meshes() { # R|S|G FILE
    try "$1" "$2" fettle-align good.pcd --to "$2" --near
    try "$1" "$2" fettle-clean "$2" --facing 0,0,1
    try "$1" "$2" fettle-collide robot.json good.pcd --workpiece "$2"
    try "$1" "$2" fettle-compare good.pcd --to "$2"
    try "$1" "$2" fettle-compare "$2" --to plate.stl
    try "$1" "$2" fettle-diff "$2" plate.stl
    try "$1" "$2" fettle-diff plate.stl "$2"
    try "${1/G/S}" "$2" fettle-find good.pcd --against "$2" --transform-in identity.txt
    try "$1" "$2" fettle-finish "$2" --cutter ball:6 --step-over 4
    try "$1" "$2" fettle-grind plan.json --stock "$2" --cell 2
    try "${1/G/S}" "$2" fettle-margin job.json fit.json --scan "$2"
    try "$1" "$2" fettle-mill path.nc --stock "$2" --cutter ball:6 --step 0.5
    stocks "$@"
    try "$1" "$2" fettle-place "$2" --up plane
    try "$1" "$2" fettle-render "$2"
    try "$1" "$2" fettle-report --job job.json --before "$2"
    try "$1" "$2" fettle-sample job.json --on "$2"
    try "$1" "$2" fettle-surfel "$2" --stock plate.stl --spacing 4
    try "$1" "$2" fettle-surfel plate.stl --stock "$2" --spacing 4
    try "$1" "$2" fettle-verify "$2" --design plate.stl --step 4
    try "$1" "$2" fettle-verify plate.stl --design "$2" --step 4
    try "$1" "$2" fettle-view "$2"
}

# Binary files: numbers as Perl's pack writes them.
binary() { perl -e 'print pack(shift, @ARGV)' -- "$@"; }

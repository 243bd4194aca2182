# A first line of 1 GB, as each format may begin it, in every kind of place where a tool reads: refused from its beginning, in the
# memory that the tool itself needs and in a small part of the time that the whole line would take. JSON may be one long line: of
# that, and of any other endless input where JSON is expected, 64 MiB are read.
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
endless() { # BEGIN PLACE COMMAND…: "-" in it is the line
    local status=0 begin=$1 place=$2
    shift 2
    tried=$((tried + 1))
    { printf '%s' "$begin"; ${fill:-line}; } 2>/dev/null |
        ( ulimit -t 2; exec /usr/bin/time -q -o rss -f '%M' "$@" ) >out 2>err || status=$?
    if [ "$(tail -n 1 rss)" -gt $kOwnMemory ]; then say "$(tail -n 1 rss) KiB" "$@"
    elif [ $status != 2 ] || [ -s out ] || [ "$(wc -l <err)" != 1 ] || ! grep -q "$place.*: .*\(longer than\|a line of more\)" err; then
        say "status $status: $(head -c 200 err)" "$@"
    fi
}
line() { head -c 1G /dev/zero | tr '\0' a; }
for begin in '' '# ' 'VERSION ' 'ply' 'solid ' 'OFF ' 'v ' '1 2 3 ' $'\357\273\277x y z '; do
    endless "$begin" stdin fettle-form flatness -
    endless "$begin" stdin fettle-path -
    endless "$begin" stdin fettle-verify - --design plate.stl --step 4
    endless "$begin" stdin fettle-compare - --to plate.stl
    endless "$begin" /dev/stdin fettle-sample job.json --on /dev/stdin
    endless "$begin" stdin fettle-report --trace -
done
endless '% ' stdin fettle-mill - --stock box:0,0,0,9,9,9 --cutter ball:6 --step 0.5
endless '' stdin fettle-mesh - --at good.pcd
endless '' stdin fettle-plan - surface.json
endless '' stdin fettle-grind - --stock good.pcd --cell 0.5
endless '' stdin fettle-arm - --inverse good.pcd
endless '' stdin fettle-belt good.pcd --path good.pcd --wheel - --force 5
endless '' stdin fettle-part -
endless '1 connect ' stdin fettle-gantry-virtual plan.json --stock good.pcd --cell 0.5
endless "0 1 " stdin fettle-manual job.json --stock good.pcd --cell 0.5 --machine machine.json --lowest 0 --trace trace.pcd --steer -
json() { # BEGIN: in every kind of place where JSON may be
    endless "$1" stdin fettle-plan - surface.json
    endless "$1" stdin fettle-plan job.json -
    endless "$1" stdin fettle-part -
    endless "$1" stdin fettle-diff - job.json
    endless "$1" stdin fettle-surfel - --stock plate.stl
    endless "$1" stdin fettle-report --job -
    endless "$1" /dev/stdin fettle-belt good.pcd --path good.pcd --wheel /dev/stdin --force 5
    endless "$1" stdin fettle-compare - --to plate.stl
    endless "$1" stdin fettle-form flatness -
}
json '{"kind": "'
fill='yes "x":1,' json $'{\n'
fill=yes endless '' stdin fettle-plan - surface.json
fill=yes endless '' stdin fettle-fit - good.pcd
mkfifo pipe
yes >pipe & # until the reader ends
endless '' pipe fettle-plan pipe surface.json
# a file is refused by its size: nothing of it is read
truncate -s 1T sparse.json
printf '{"kind": "job"' | dd of=sparse.json conv=notrunc status=none
endless '' sparse.json fettle-fit sparse.json good.pcd
# what does not fit into memory is named
truncate -s 4G sparse.off
printf 'OFF\n3 1 0\n' | dd of=sparse.off conv=notrunc status=none
(ulimit -v 2000000; "$HERE/../refuses" 'sparse.off: does not fit into memory: 4096 MiB' fettle-diff sparse.off sparse.off)
all_tried 80

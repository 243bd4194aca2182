# On a terminal the wheel goes where arrow keys send it, 0.1 s at the job's 20 mm/s each, and rests while there are none. Reference: the distance.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
command -v script > /dev/null || { echo 'script (bsdutils) is not installed' >&2; exit 77; }
make_job 0
make_stock 4
cat > keys.sh << END
fettle-manual job.json --stock stock.stl --cell 0.4 --machine $SAMPLES/machines/full_scale.json --steer /dev/tty --trace trace.pcd --ascii -o ground.pcd
END
begun() { # waits until the tool of this folder runs: keys that come before it are the shell's, which echoes them
    local process
    for _ in {1..200}; do
        for process in /proc/[0-9]*; do
            if [ "$(cat "$process/comm" 2> /dev/null)" = fettle-manual ] && [ "$(readlink "$process/cwd")" = "$PWD" ]; then return; fi
        done
        sleep 0.1
    done
}
up=$'\033[A' right=$'\033[C'
{ begun; sleep 1; printf %s "$up"; sleep 0.5; printf %s "$right"; sleep 0.5; printf q; } | timeout 60 script -qec 'bash keys.sh' /dev/null > shown
[ ! -s shown ] || { cat shown; exit 1; }
awk '/^DATA/ { body = 1; next } body { if (!n++) { x = $1; y = $2 } last = $1 - x " " $2 - y } END { print last }' trace.pcd > way
awk '{ exit !($1 > 1.7 && $1 < 2.3 && $2 > 1.7 && $2 < 2.3) }' way || { cat way; exit 1; }

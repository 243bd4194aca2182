# Killed with -9 at 20 moments of a session: what was shown, touched and ground until then is in the folder, and --resume goes on from
# there without doing it again; the machine moves only on a command. Then a power failure that has taken the last rows of the trace.
# References: an undisturbed session; the plane.
# shellcheck source=tests/fettle-station/kit.bash
. "$HERE/kit.bash"
make_job 0
make_stock 4
options=(--gantry virtual:dynamic --machine "$machine")
{ show; echo '3 start'; } > steer.txt
begun=$(date +%s%N)
station whole steer.txt "${options[@]}"
took=$(( ($(date +%s%N) - begun) / 1000000 )) # ms
shift=$(jq .prediction.shift whole/surface.json)
# What is missing yet, whatever the session had come to.
rest() { # FOLDER
    local stage points
    stage=$(jq -r .stage "$1/session.json")
    points=$(jq '.anomaly | length' "$1/session.json")
    case $stage in
    anomaly) show $((points + 1)) ;;
    sampling) printf '0 next\n0 start\n' ;;
    touch) echo '0 start' ;;
    esac
    echo '9 start'
}
beginning_of() { # FILE FILTER: is the list in the session's file the beginning of the undisturbed one?
    jq -e --slurpfile whole whole/session.json "$2 as \$list | \$whole[0] | $2[:(\$list | length)] == \$list" "$1" > ok
}
RANDOM=1
stages=
for n in {1..20}; do
    rm -rf session
    become_station session steer.txt "${options[@]}" &
    sleep "$(awk -v t=$took -v r=$RANDOM -v n="$n" 'BEGIN { print t / 1000 * (n - 1 + r / 32768) / 20 }')"
    kill -9 $! 2> killed || true
    wait $! 2> killed || true
    if [ ! -e session/session.json ]; then station session steer.txt "${options[@]}"; continue; fi
    stages+=" $(jq -r .stage session/session.json)"
    beginning_of session/session.json .anomaly
    beginning_of session/session.json .touches
    [ "$(jq -r .stage session/session.json)" != grind ] || grinding=1
    : > kept_rows
    [ ! -e session/trace.pcd ] || rows session/trace.pcd | awk '$7 != 13' > kept_rows
    rows whole/trace.pcd | awk -v n="$(wc -l < kept_rows)" 'NR <= n' | cmp - kept_rows
    # Nothing moves but by a start.
    cp -r session idle
    : > nothing.txt
    [ "$(jq -r .stage session/session.json)" = "done" ] || ends_with 1 station idle nothing.txt "${options[@]}" --resume
    [ ! -e session/trace.pcd ] || cmp session/trace.pcd idle/trace.pcd
    rm -rf idle
    rest session > rest.txt
    station session rest.txt "${options[@]}" --resume --report report.json
    jq -e '.finished and .touches == 4' report.json > ok
    rows session/trace.pcd | awk -v n="$(wc -l < kept_rows)" 'NR <= n' | cmp - kept_rows
    is_flat "$shift" session/ground.pcd
done
echo "$stages"
[ -n "${grinding:-}" ]

# Without power the last pages may be lost though the header counts their rows: what the last checkpoint vouches for is kept.
rm -rf session
become_station session steer.txt "${options[@]}" --pace 20 &
for _ in {1..300}; do if [ -e session/trace.pcd.checkpoint ] && [ "$(cut -d ' ' -f 1 session/trace.pcd.checkpoint)" -gt 200 ]; then break; fi; sleep 0.05; done
kill -9 $!
wait $! 2> killed || true
kept=$(cut -d ' ' -f 1 session/trace.pcd.checkpoint)
rows session/trace.pcd | awk -v n="$kept" 'NR <= n' > kept_rows
[ "$(wc -l < kept_rows)" = "$kept" ]
size=$(stat -c %s session/trace.pcd)
header=$(grep -ab -m 1 '^DATA' session/trace.pcd | cut -d : -f 1)
from=$((header + 11 + kept * 240))
head -c "$from" session/trace.pcd > cut.pcd
head -c $((size - from)) /dev/zero >> cut.pcd
cp cut.pcd session/trace.pcd
rest session > rest.txt
station session rest.txt "${options[@]}" --resume --report report.json 2> said
jq -e '.finished' report.json > ok
[ "$size" = "$from" ] || grep -q 'its last rows are lost' said
rows session/trace.pcd | awk -v n="$kept" 'NR <= n' | cmp - kept_rows
is_flat "$shift" session/ground.pcd

# One session at a time.
{ show; echo '3 start'; } > steer.txt
mkfifo pipe
become_station busy pipe "${options[@]}" &
exec 3> pipe
echo '0 0 0' >&3
for _ in {1..100}; do [ -e busy/session.json ] && break; sleep 0.05; done
ends_with 2 station busy steer.txt "${options[@]}" --resume
grep -q 'another session is using it' said
exec 3>&-
wait $! || true

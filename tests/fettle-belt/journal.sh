# A run that is killed again and again goes on from its journal and ends with the bytes of one that was not: surfels, trace, report
# and the table of the errors. Moments of the kills are chance. The table's last line is what fettle-assess says of the result.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate > plate.pcd
wheel 10 0.45 > wheel.json
awk 'BEGIN {
    n = 240
    printf "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz force pass\nSIZE 4 4 4 4 4 4 4 4 4\nTYPE F F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1 1\n"
    printf "WIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n", n, n
    for (i = 0; i < n; ++i) printf "%g %g 5.25 1 0 0 0 %g %d\n", (i % 80) / 8 - 5, int(i / 80) * 3 - 3, 8 + i % 7, int(i / 80) }' > path.pcd
run() { # NAME OPTION...; replaces the shell
    exec fettle-belt plate.pcd --wheel wheel.json --path path.pcd --feed 0.003 --trace "$1.trace.pcd" --report "$1.json" --watch "$1.csv" \
        --lower 0.1 --upper 0.2 --cells 64 -o "$1.pcd" "${@:2}"
}
(run whole)
kills=0
for ((i = 0; i < 60 && kills < 8; ++i)); do
    (run killed --journal run.journal --journal-every 0) & pid=$!
    sleep "0.$((RANDOM % 500 + 100))"
    kill -9 $pid 2>/dev/null || true
    wait $pid 2>/dev/null && break
    [ ! -e killed.pcd ] || break
    kills=$((kills + 1))
done
[ $kills -gt 0 ]
(run killed --journal run.journal)
for end in pcd trace.pcd json csv; do cmp whole.$end killed.$end; done
# The journal of a run that is done gives the result again.
(run again --journal run.journal)
cmp whole.pcd again.pcd
cmp whole.csv again.csv
fettle-assess whole.pcd --lower 0.1 --upper 0.2 --report assessed.json > errors.pcd || [ $? = 1 ]
tail -1 whole.csv | tr , ' ' | { read -r point t gouge within undercut mean rms min
    [ "$point" = 239 ]
    jq -e "((.mean - $mean) | fabs) < 1e-6 and ((.rms - $rms) | fabs) < 1e-6 and ((.min - $min) | fabs) < 1e-6 and .gouge == $gouge and
           .undercut == $undercut and .count - .gouge - .undercut == $within" assessed.json > ok
    jq -e "(.time / $t - 1 | fabs) < 1e-5 and .points == 240" whole.json > ok; }
[ "$(wc -l < whole.csv)" = 241 ]
# Some surfels change their class on the way.
[ "$(cut -d, -f4 whole.csv | sort -u | wc -l)" -gt 5 ]
refused() { "$HERE/../refuses" "$@"; }
refused 'run.journal: this is the journal of another run' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --feed 0.2 --journal run.journal
cp path.pcd other.pcd
refused 'other.pcd: not a journal of fettle-belt' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --feed 0.003 --journal other.pcd
refused 'path.pcd: is an input, which would be lost' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --feed 0.003 --journal path.pcd
head -c 5000 run.journal > short.journal
refused 'short.journal: ' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --feed 0.003 --journal short.journal
# A bit that has flipped: in the digests, in a count, in the displacements, anywhere.
size=$(stat -c %s run.journal)
for place in 5 30 100 152 160 $((size / 3)) $((size / 2)) $((size - 1)); do
    cp run.journal broken.journal
    byte=$(od -An -tu1 -j "$place" -N 1 run.journal)
    printf %b "\\$(printf %03o $((byte ^ 4)))" | dd of=broken.journal bs=1 seek="$place" conv=notrunc status=none
    refused 'broken.journal: ' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --feed 0.003 --cells 64 \
        --lower 0.1 --upper 0.2 --watch broken.csv --journal broken.journal
done
sed '1s/journal [0-9]*/journal 0/' run.journal > older.journal
refused 'older.journal: the journal is corrupt, or of another version' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --feed 0.003 --journal older.journal
{ cat run.journal; printf '\0\0\0\0\0\0\0\0'; } > long.journal
refused 'long.journal: the journal is corrupt' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --feed 0.003 --cells 64 \
    --lower 0.1 --upper 0.2 --watch long.csv --journal long.journal
refused '--watch' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --watch w.csv --lower 0
refused '--lower: is more' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --watch w.csv --lower 1 --upper 0
refused '/missing/w.csv' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --watch /missing/w.csv --lower 0 --upper 1
refused '/missing/j' fettle-belt plate.pcd --wheel wheel.json --path path.pcd --journal /missing/j

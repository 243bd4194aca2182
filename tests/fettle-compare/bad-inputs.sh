# Everything refused: exit 2, one line that names the file or option and the value, nothing on stdout.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n' >plate.obj
printf '5 5 0.5\n' >one.xyz
: >empty.pcd
printf '{"kind": "job"}' >job.json
refused() {
    local status=0
    fettle-compare "$@" >out 2>err </dev/null || status=$?
    [ $status -eq 2 ] && [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ] || { echo "not refused: $*: $status" >&2; exit 1; }
    sed 's/ (see .*//' err
}
refused empty.pcd --to plate.obj
refused one.xyz --to empty.pcd
refused missing.pcd --to plate.obj
refused one.xyz
refused one.xyz --to plate.obj --within job.json
refused one.xyz --to plate.obj --tolerance -1
refused one.xyz --to plate.obj --histogram bins.csv --bins 0
[ ! -e bins.csv ]
refused one.xyz --to plate.obj --tolerance nan
refused one.xyz --to plate.obj --max-distance 0
refused one.xyz --to plate.obj --mode zz
refused one.xyz --to plate.obj --mode direction
refused one.xyz --to plate.obj --direction 0,0,1
refused one.xyz --to plate.obj --mode direction --direction 0,0
refused one.xyz --to plate.obj --mode direction --direction 0,0,1,
refused one.xyz --to plate.obj --mode direction --direction 0,0,0
refused one.xyz --to plate.obj --to-units ft
# What can be read is: one point, NaN points, a cloud too small to be a surface.
fettle-compare one.xyz --to plate.obj --report report.json >errors.pcd && jq -e '.count == 1 and .sd == 0' report.json
printf 'nan nan nan\n5 5 0.5\n' | fettle-compare --to plate.obj --report report.json >errors.pcd
jq -e '.count == 1 and .undefined == 1' report.json
# Where no point has an error nothing was compared: exit 1, and a line says so.
status=0
fettle-compare one.xyz --to one.xyz --report report.json >errors.pcd 2>err || status=$?
[ $status -eq 1 ]
[ "$(cat err)" = 'fettle-compare: warning: no point has an error: nothing was compared' ]
jq -e '.count == 0 and .mean == null' report.json
fettle-compare one.xyz --to plate.obj --reverse back.pcd --max-distance 3 --report report.json >errors.pcd 2>err
grep -q 'warning: --reverse: no point has an error' err

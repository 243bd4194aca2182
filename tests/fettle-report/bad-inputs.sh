# What no page can be made of: exit 2, one line that names the file. Reference: the rules of every tool.
refuses=$HERE/../refuses
job=$SAMPLES/jobs/wang1.json
"$refuses" 'nothing to report: name at least one file of the run' fettle-report
"$refuses" 'nowhere.json: cannot open' fettle-report --job nowhere.json
echo '{"count": 3}' >short.json
"$refuses" 'short.json: kind: missing' fettle-report --comparison short.json
echo '{"kind": "comparison", "units": {"length": "mm"}, "count": 3}' >short.json
"$refuses" 'short.json: undefined: missing' fettle-report --comparison short.json
"$refuses" 'short.json: in mm, but the run is in in' fettle-report --job "$job" --comparison short.json
"$refuses" 'short.json: kind: expected "grinding", got "comparison"' fettle-report --grinding short.json
jq -n '{count: 3, undefined: 0, mean: 0, mean_abs: 0, rms: 0, sd: 0, min: 0, max: 0, band: 0, p01: 0, p05: 0, p50: 0, p95: 0, p99: 0, within: 1,
    over_cut_area: 0, under_cut_area: 0, over_cut_volume: 0, under_cut_volume: 0} |
    . + {kind: "comparison", units: {length: "mm"}, regions: {outside: .}, verdict: "within", judged: "inside", tolerance: 1, worst: 0}' >short.json
"$refuses" "short.json: judged: there is no region 'inside'" fettle-report --comparison short.json
echo '{"kind": "grinding", "units": {"length": "in", "force": "lbf"}}' >short.json
"$refuses" 'short.json: finished: missing' fettle-report --grinding short.json
"$refuses" 'wang1.json: kind: expected "plan", got "job"' fettle-report --plan "$job"
"$refuses" 'wang1.json: ' fettle-report --alignment "$job"
"$refuses" 'wang1.json: kind: expected "form", got "job"' fettle-report --form "$job"
echo '{"kind": "form", "units": {"length": "mm"}, "form": "flatness", "count": 3, "least_squares": 1, "minimum_zone": 1, "dropped": 0, "outliers": 0}' >form.json
"$refuses" 'form.json: in mm, but the run is in in' fettle-report --job "$job" --form form.json
"$refuses" 'wang1.json: kind: expected "surface", got "job"' fettle-report --surface "$job"
echo '{' >broken.json
"$refuses" 'broken.json: ' fettle-report --comparison broken.json
for fields in 'x y z' 'x y z t layer'; do
    n=$(wc -w <<<"$fields")
    row() { for ((i = 0; i < n; i++)); do printf ' %s' "$1"; done; }
    printf '# .PCD v0.7\n# units mm\nVERSION 0.7\nFIELDS %s\nSIZE%s\nTYPE%s\nCOUNT%s\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n%s\n' \
        "$fields" "$(row 4)" "$(row F)" "$(row 1)" "$(row 1)" >"$n.pcd"
done
"$refuses" "3.pcd: the points have no field 'error'" fettle-report --errors 3.pcd
"$refuses" "3.pcd: the points have no field 't'" fettle-report --trace 3.pcd
"$refuses" "5.pcd: the points have no field 'event'" fettle-report --trace 5.pcd
"$refuses" '3.pcd: ' fettle-report --job "$job" --samples 3.pcd # mm against in
printf 'x y z error\nnan nan nan 1\n' >nowhere.xyz
printf '1 1 0\n2 1 0\n1 2 3\n' >some.xyz
"$refuses" 'nowhere.xyz: no point has a finite x and y: there is nothing to draw' fettle-report --before some.xyz --after nowhere.xyz
"$refuses" 'nowhere.xyz: no point has a finite x, y and z: there is nothing to draw' fettle-report --errors nowhere.xyz
awk 'BEGIN { print "x y z error class"; for (i = 0; i < 30; ++i) print i % 5, i / 5, 0, 0, i }' >classes.xyz
"$refuses" "classes.xyz: field 'class' has more than 20 different values: these are no classes" fettle-report --errors classes.xyz
"$refuses" 'nowhere.xyz: no point has a finite x and y: there is nothing to draw' fettle-report --errors nowhere.xyz --after some.xyz
trace() { # ROW…: t layer event force feed
    printf '# .PCD v0.7\n# units mm N\nVERSION 0.7\nFIELDS x y z t layer event force feed\nSIZE 4 4 4 4 4 4 4 4\nTYPE F F F F F F F F\nCOUNT 1 1 1 1 1 1 1 1\nWIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n' $# $#
    printf '0 0 0 %s\n' "$@"
}
trace '2 1 0 0 0' '1 1 0 0 0' >back.pcd
"$refuses" 'back.pcd: point 1: t decreases or is not finite: 1' fettle-report --trace back.pcd
trace '2 1e30 0 0 0' >layer.pcd
"$refuses" 'layer.pcd: point 0: there is no layer 1e+30' fettle-report --trace layer.pcd
trace '0 1 0 nan 0' '1 1 0 nan nan' '2 1 0 5 1' >feed.pcd
fettle-report --trace feed.pcd >feed.html
xmllint --noout feed.html
! grep -qE '="([^"]*[^a-z"])?(nan|inf)[^a-z]' feed.html || exit 1
trace '0 1 0 nan 0' '1 1 0 nan 1' >nan.pcd # nothing was measured: a page without a line
fettle-report --trace nan.pcd >nan.html
xmllint --noout nan.html
! grep -qE '="([^"]*[^a-z"])?(nan|inf)[^a-z]' nan.html || exit 1
"$refuses" '--before-units' fettle-report --before 3.pcd --before-units ft

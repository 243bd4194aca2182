# Every output of every tool goes by the suffix of its name. Clouds: PLY, CSV and VTK hold what the PCD does (fettle-diff reads PLY; the
# points are counted in the others); meshes: PLY holds the STL's triangles. Any other suffix is refused, and the known ones are named.
# Reference: the tool's own PCD or STL.
# shellcheck source=tests/robustness/tools.bash
. "$HERE/tools.bash"
inputs 5
cp "$SAMPLES/programs/pocket.nc" path.nc 2>/dev/null || true
run() { "fettle-$name" "${command[@]}" "$@" -q >out 2>err <<<"$lines" || [ $? = 1 ] || say "$* status $?: $(head -c 200 err)" "$name"; }
refused() { # FILE: named by an option that must not take it
    local status=0
    "fettle-$name" "${command[@]}" "$@" >out 2>err <<<"$lines" || status=$?
    tried=$((tried + 1))
    is_refusal $status "is no format of this output: ." || say "$* status $status: $(head -c 200 err)" "$name"
}
# PLY has no viewpoint and three fields for a colour, which are left out of both.
plain() { fettle-compare "$1" --to plate.stl -q --format csv --mode z | tail -n +2 | cut -d , -f 1-3; }
same() { # PCD PLY
    local field
    grep -a -q '^comment units' "$2" && fettle-diff --tol 1e-6 <(plain "$1") <(plain "$2") >out || return 1
    for field in $(sed -n 's/^FIELDS x y z//p;/^DATA/q' "$1" | tr ' ' '\n' | grep -v -E '^(rgb|normal_.)$'); do
        grep -a -q -E "property (float|double|char|uchar|short|ushort|int|uint) (scalar_)?$field\$" "$2" || { echo "no $field" >out; return 1; }
    done
}
clouds=0
for name in $names; do
    command_of "$name"
    case $name in # what makes a cloud of them
    stock-linuxcnc) continue ;; # without --after it writes no cloud
    verify) command=(--corrected corrected.nc "${command[@]}") ;;
    belt) command=(--watch watch.csv "${command[@]}") ;;
    mill | finish) command=(--pcd "${command[@]}") ;;
    part) command=(--cloud "${command[@]}") ;;
    align) command+=(--transform-in identity.txt --iterations 0) ;;
    esac
    help=$("fettle-$name" --help)
    [ ${#bulk[@]} = 0 ] || grep -q -- '--gcode\|fettle-diff' <<<"$help" || refused -o "$name.svgz"
    [ "$name" = station ] || refused --report "$name.txt"
    grep -q -- '--format pcd|ply|csv|vtk' <<<"$help" || continue
    clouds=$((clouds + 1))
    for format in pcd ply; do run -o "$name.$format"; done
    same "$name.pcd" "$name.ply" || say "PLY: $(head -c 200 out)" "$name"
    run --format csv
    [ $(($(wc -l <out) - 1)) = "$(sed -n 's/^POINTS //p;/^DATA/q' "$name.pcd")" ] || say "rows of the CSV" "$name"
    head -n 1 out | grep -q '^x,y,z' || say "head of the CSV" "$name"
done
[ $clouds = 23 ] || say "$clouds tools write clouds" formats
# The other clouds that tools write go by their suffixes, too.
another() { # OPTION
    for format in pcd ply; do run "$1" "other.$format"; done
    same other.pcd other.ply || say "$1: $(head -c 200 out)" "$name"
}
for pair in compare:--reverse verify:--z-errors belt:--trace mill:--trace plan:--path gantry-virtual:--ground; do
    name=${pair%:*}
    command_of "$name"
    [ "$name" != verify ] || command=(--corrected corrected.nc "${command[@]}")
    [ "$name" != belt ] || command=(--watch watch.csv "${command[@]}")
    another "${pair#*:}"
done
# Meshes
for name in part reconstruct; do
    command_of "$name"
    for format in stl ply; do run -o "$name.$format"; done
    fettle-compare "$name.ply" --to "$name.stl" --tolerance 1e-5 -o /dev/null || say 'PLY is not the STL' "$name"
done
# Lengths in another unit, in the points and in the report.
awk 'BEGIN { for (i = 0; i < 9; i++) for (j = 0; j < 9; j++) print 0.001 * i, 0.001 * j, 0.0001 * (i % 2) }' >m.xyz
awk 'BEGIN { for (i = 0; i < 9; i++) for (j = 0; j < 9; j++) print 0.001 * i, 0.001 * j, 0 }' | sed 's/^/v /' >m.obj
awk 'BEGIN { for (i = 0; i < 8; i++) for (j = 0; j < 8; j++) { k = 9 * i + j + 1; print "f", k, k + 9, k + 10; print "f", k, k + 10, k + 1 } }' >>m.obj
compare() { fettle-compare m.xyz --file-units m --to m.obj --to-units m "$@" --report r.json -o e.csv; }
compare                     # a part in metres is reported in mm
jq -e '.units.length == "mm" and (.max - 0.1 | fabs) < 1e-6' r.json >/dev/null
compare --units m
jq -e '.units.length == "m" and (.max - 0.0001 | fabs) < 1e-9' r.json >/dev/null
compare --units in
jq -e '.units.length == "in" and (.max - 0.1 / 25.4 | fabs) < 1e-7' r.json >/dev/null
all_tried 55

# Programs in four languages of five checked paths, read back by a reader that knows nothing of the writer: no target is more than 1 um
# or 0.001 degrees off its pose. Reference: the paths.
. "$HERE/../fettle-collide/parts.bash"
robot=$SAMPLES/robots/irb1400.json
jq 'del(.track) | .base = {position: [0, 1000, 0]}' "$robot" >fixed.json # what URScript can move
# PATH PART TOLERANCE: checked, and its four programs read back
read_back() {
    fettle-collide fixed.json "$1.pcd" --workpiece "$2" --tolerance "$3" -q --ascii -o "$1-checked.pcd"
    fettle-arm fixed.json --forward "$1-checked.pcd" --feed 50 --rapid "$1.mod" --krl "$1.src" --ls "$1.ls" --urscript "$1.script" -q -o /dev/null
    awk 'data { print $1, $2, $3, $4, $5, $6, $7 } $1 == "DATA" { data = 1 }' "$1-checked.pcd" | tail -n +2 >"$1.poses"
    for language in "rapid $1.mod" "krl $1.src" "ls $1.ls,${1^^}_1.ls 475" "urscript $1.script"; do
        # shellcheck disable=SC2086
        python3 "$HERE/read-program.py" $language >back
        # the base is at 0, 1000, 0 in the cell
        paste -d' ' "$1.poses" back | awk -v name="$language" '
            function abs(a) { return a < 0 ? -a : a }
            { if (NF != 14) { print name ": " NF " numbers in line " NR; exit 1 }
              d = sqrt(($1 - $8) ^ 2 + ($2 - $9 - 1000) ^ 2 + ($3 - $10) ^ 2)
              c = abs($4 * $11 + $5 * $12 + $6 * $13 + $7 * $14)
              s = 0; for (k = 4; k <= 7; ++k) { e = $k - (($4 * $11 + $5 * $12 + $6 * $13 + $7 * $14) < 0 ? -1 : 1) * $(k + 7); s += e * e }
              if (d > far) far = d; if (s > most) most = s }
            END { if (NR == 0 || far > 1e-3 || 2 * sqrt(most) * 57.3 > 1e-3) { printf "%s: %g mm, %g degrees\n", name, far, 2 * sqrt(most) * 57.3; exit 1 } }'
    done
}
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
cp "$SAMPLES/paths/keel.pcd" keel.pcd
read_back keel keel.stl 0.01
for part in cylinder blade hull; do
    "make_$part" && read_back $part $part.stl 0.2
done
cylinder_rows along && mv cylinder.pcd along.pcd
read_back along cylinder.stl 0.2

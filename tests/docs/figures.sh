# The table of the README, What it reaches, is what the chain on Wang's parts gives. Reference: pipelines/casting.mk, seed 1.
root=$(realpath "$HERE/../..")
build=$(realpath --relative-to="$root" "$BUILD")
unset MAKEFLAGS MFLAGS
run=$PWD/chain/1
make -s -C "$root" -f pipelines/casting.mk B="$build" CHAIN="$PWD/chain" "$run"/wang{1,2,3}/errors.pcd "$run/wang1/flatness.json" \
    "$run/wang2/cylindricity.json" "$run/wang2/boundary/cylindricity.json" >&2
row() { # WORDS FORMAT FILTER: the row of the table that begins with WORDS holds these numbers of parts 1 to 3
    for part in 1 2 3; do
        jq -n --slurpfile e "chain/1/wang$part/errors.json" --slurpfile g "chain/1/wang$part/grind.json" --slurpfile s "chain/1/wang$part/sample.json" \
            '$e[0].regions.inside as $e | $g[0] as $g | $s[0] as $s | '"$3" | xargs printf " $2 |"
    done >numbers
    grep -qF "| $1 |$(cat numbers)" "$root/README.md" || { echo "README: $1: |$(cat numbers)"; exit 1; }
}
row touches %d '$s.touches'
row 'mean absolute error inside the boundary, mm' %.2f '$e.mean_abs * 25.4'
row 'largest error, mm' %.2f '[$e.max, -$e.min] | max * 25.4'
row 'below the true surface (99th percentile), mm' %.3f '[-$e.p01, 0] | max * 25.4'
row 'machine time with probing, min' %.1f '($g.machine_time + $s.probing_time) / 60'
form() { jq '.least_squares * 25.4' "chain/1/$1.json" | xargs printf '%.2f'; }
grep -qF "| flatness, cylindricity (least squares), mm | $(form wang1/flatness) | $(form wang2/cylindricity) |" "$root/README.md"
grep -qF "as touches, too (\`fettle-fit --use-boundary\`), its cylindricity is $(form wang2/boundary/cylindricity) mm." "$root/README.md"

# One stock, design and points in mm, inches and metres: all numbers and fields of what comes out are the same, in mm.
# Reference: each other.
printf 'OFF\n6 8 0\n0 0 0\n30 0 0\n0 20 0\n0 0 9\n30 0 5\n0 20 5\n3 0 2 1\n3 3 4 5\n3 0 1 4\n3 0 4 3\n3 1 2 5\n3 1 5 4\n3 2 0 3\n3 2 3 5\n' > stock.off
header='# .PCD v0.7\n# units %s\nVERSION 0.7\nFIELDS x y z feed\nSIZE 8 8 8 8\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 4\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA ascii\n'
for unit in mm in m; do
    case $unit in mm) mm=1 ;; in) mm=25.4 ;; m) mm=1000 ;; esac
    # shellcheck disable=SC2059
    { printf "$header" $unit; printf '5 4 12 0\n5 4 6 3\n12 6 5 10\n12 6 20 0\n' | awk -v mm=$mm '{ printf "%.17g %.17g %.17g %.17g\n", $1 / mm, $2 / mm, $3 / mm, $4 / mm }'; } > $unit.pcd
    awk -v mm=$mm 'NR > 2 && NF == 3 { printf "%.17g %.17g %.17g\n", $1 / mm, $2 / mm, $3 / mm; next } { print }' stock.off > $unit.off
    for what in step tolerance; do
        how=(--step 0.25)
        [ $what = step ] || how=(--tolerance 0.05 --design $unit.off --design-units $unit)
        fettle-mill $unit.pcd --stock $unit.off --stock-units $unit --cutter bull:5,1 --holder 9,4 "${how[@]}" -q --trace trace.pcd --ascii --pcd \
            --report $what-$unit.json > $what-$unit.pcd || [ $? = 1 ]
        sed '1,/^DATA/d' trace.pcd | jq -R 'split(" ") | map(tonumber)' | jq -s . > trace-$what-$unit.json
        sed '1,/^DATA/d' $what-$unit.pcd | awk '{ print $1, $2, $3, $4 }' | jq -R 'split(" ") | map(tonumber)' | jq -s . > cells-$what-$unit.json
        grep '^FIELDS' trace.pcd $what-$unit.pcd >> fields
    done
done
for what in step tolerance; do
    for unit in in m; do
        "$HERE/../scales" $unit 0 $what-mm.json $what-$unit.json
        jq -e --slurpfile b trace-$what-$unit.json '[., $b[0]] | map(flatten) | transpose | all((.[0] - .[1] | fabs) < 1e-3)' trace-$what-mm.json > ok
        jq -e --slurpfile b cells-$what-$unit.json '[., $b[0]] | map(flatten) | transpose | all((.[0] - .[1] | fabs) < 1e-3)' cells-$what-mm.json > ok
    done
done
[ "$(sort -u fields | cut -d: -f2 | sort -u)" = 'FIELDS x y z removed
FIELDS x y z t feed removed volume holder place' ]

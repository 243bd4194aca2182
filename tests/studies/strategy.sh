# The study of the layer-based strategy, for one part in the stock of its job: the make file, the tables, figure 5-8, and a figure missed.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-grind)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/strategy.mk B="$build" STRATEGY="$PWD/all" PARTS=hill FACTORS=1 SHOWN=hill > table
[ "$(grep -c 'times as long' table)" = 2 ]
head -c 8 all/hill.png | cmp - <(printf '\211PNG\r\n\032\n')
# Both ways take the same metal off: to a hundredth, since layer 1 may leave less than its tolerance in one way than in the other.
jq -es '.[0].removed_volume / .[1].removed_volume | . > 0.99 and . < 1.01' all/hill/1/case3.json all/hill/1/tall.json > same
# Layers of the prism: 2e-3 in³/(lbf s) * 15 lbf / (0.2 in * 1 in/s) = 0.15 in apart, so 2 for 0.27 in of metal and 4 for 0.5 in.
jq -es 'map(.layers) == [2, 4] and (.[0].layer_distance - 0.15 | fabs) < 1e-9 and (.[0].prism_height - 0.27 | fabs) < 1e-3' all/hill/1/prism.json all/hill/1/tall.json > layers
# Tables that a spreadsheet reads: every row has as many cells as its headline, commas of a sentence are within quotes.
for table in prism overlap; do
    /usr/bin/python3 -c 'import csv, sys; rows = list(csv.reader(open(sys.argv[1]))); assert len(rows) > 1 and {len(r) for r in rows} == {11}' "all/$table.csv"
done
# Only the pictures of the parts that are ground are made.
make -n --no-print-directory -C "$root" -f pipelines/strategy.mk B="$build" STRATEGY="$PWD/none" PARTS=moon FACTORS=1 > plan
grep -q moon.png plan && [ "$(grep -c hills plan)" = 0 ]
awk '/^FIELDS/ { for (i = 2; i <= NF; i++) if ($i == "force") at = i - 1 } body { $at = 1 } /^DATA/ { body = 1 } { print }' all/hill/1/tall.pcd > air.pcd
mv air.pcd all/hill/1/tall.pcd # no air at all
status=0
(cd "$root" && pipelines/strategy-table "$OLDPWD/all" hill 1) > bad || status=$?
[ $status = 1 ]
[ "$(grep -c MISSED bad)" = 1 ]

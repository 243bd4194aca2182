# A part made with a seed, from raw to judged: a row for each anomaly, and one page that lists their pages, by links that lead there.
# Reference: what the part was made of, and what the runs wrote.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-find)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/parts.mk B="$build" PARTS="$PWD/parts" sample COUNT=1 > table 2> warnings || [ $? = 2 ]
cat table
cmp table parts/table.csv
jq -es 'length == 1 and all(.status != "failed" and (.anomalies | length) >= 1)' parts/part-1/part.json > ok
ground=$(jq -s '[.[].anomalies[] | select(.page)] | length' parts/part-1/part.json)
[ "$ground" -ge 1 ]
grep -o '<a href="[^"]*"' parts/index.html | cut -d'"' -f2 > links
[ "$(wc -l < links)" = "$ground" ]
while read -r page; do [ -s "parts/$page" ]; done < links

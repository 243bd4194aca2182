# From a part that lies anyhow to a page for each anomaly, no polygon typed: the make file with its cleaning, and the table.
# Reference: the part without its bead and burr; what the jobs' runs wrote.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-find)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
fettle-part "$SAMPLES/parts/hammer.json" | fettle-place - --turn x,140,z,35 -o worn.stl
fettle-part "$SAMPLES/parts/hammer.json" --without-anomaly | fettle-place - --turn x,140,z,35 -o truth.stl
make --no-print-directory -s -C "$root" -f pipelines/raw.mk B="$build" RAW="$PWD/raw" part NAME=hammer PART="$PWD/worn.stl" TRUTH="$PWD/truth.stl" LIMIT=0.4 > table 2> warnings
cat table
row=$(jq '.anomalies | max_by(.height) | .anomaly' raw/hammer/found.json)
grep -E "^ +$row .* within  .*/$row/report.html$" table
jq -e '.verdict == "within" and .regions.inside.count > 10000' "raw/hammer/$row/errors.json" > ok
[ -s "raw/hammer/$row/found.png" ]
[ -s "raw/hammer/$row/report.html" ]
jq -r '.anomalies[] | select(.job == "") | .doubt' raw/hammer/found.json | while read -r doubt; do grep -q "$doubt\$" table || exit 1; done
[ "$(wc -l < table)" = $((1 + $(jq '.anomalies | length' raw/hammer/found.json))) ]
# The margin of a free-form surface goes by the scan, too.
fettle-part "$SAMPLES/parts/crown.json" -q -o crown.stl
fettle-part "$SAMPLES/parts/crown.json" --without-anomaly -q -o crown-truth.stl
make --no-print-directory -s -C "$root" -f pipelines/raw.mk B="$build" RAW="$PWD/raw" part NAME=crown CLEAN=no PART="$PWD/crown.stl" TRUTH="$PWD/crown-truth.stl" \
    TEMPLATE=samples/jobs/crown.json LIMIT=0.4 > crown-table 2> crown-warnings
jq -e '.surface.type == "freeform"' raw/crown/jobs/1.json
jq -e '.verdict == "within"' raw/crown/1/errors.json
fettle-fit raw/crown/jobs/1.json raw/crown/1/samples.pcd -q | fettle-margin raw/crown/jobs/1.json --scan crown.stl | cmp - raw/crown/1/desired.json

# Feeds planned for the blade, through the make file: less than a third of what the best constant leaves, on surfels other than those
# planned on; the table reports when it is not so. Reference: fettle-belt and fettle-assess with the constant.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-feed)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/belt.mk plan B="$build" BELT="$PWD/out" SPACING=1 STEP=2 VARY=feed WHEEL=samples/wheels/crowned_preston.json > table
test "$(grep -c '^feed .*reached$' table)" = 1
jq -e '.ratio < 0.2 and .converged and .rms_before > 0.39 and .reached / .touched > 0.99' out/plan/feed/report.json > ok
jq -e --slurpfile constant out/plan/feed/constant/errors.json '.rms < 0.3 * $constant[0].rms and .within > 2 * $constant[0].within' out/plan/feed/planned/errors.json > ok
test -s out/plan/feed/planned/errors.png
jq '.rms = 0.03' out/plan/feed/planned/errors.json > worse.json
mv worse.json out/plan/feed/planned/errors.json
status=0
"$root/pipelines/plan-table" out/plan/feed > bad || status=$?
test $status = 1
grep -q '^feed .*MISSED$' bad

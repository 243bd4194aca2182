# The budget of errors, for one part, two sources and all: the make file, the table, and a figure missed.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-grind)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/budget.mk B="$build" BUDGET="$PWD/all" PARTS=wang1 SETS='none printing registration all' DRAWS=1 > table
[ "$(grep -c reached table)" = 1 ]
# Without any source the ground plane is the plane, but for what the strategy leaves: less than its tolerance of 0.1 mm.
jq -e '.regions.inside | .undefined == 0 and .max < 0.004 and .min > -0.0004' all/wang1/none/1/errors.json > none
# What one source does is its own size: two prints of 0.1 mm differ by 0.14 mm rms on a large part, here by 0.05 to 0.3.
jq -e '.regions.inside.rms * 25.4 | . > 0.05 and . < 0.3' all/wang1/printing/1/errors.json > printing
jq '.regions.inside.mean_abs = 0.02' all/wang1/all/1/errors.json > worse.json
mv worse.json all/wang1/all/1/errors.json
status=0
(cd "$root" && pipelines/budget-table "$OLDPWD/all" wang1 'none all' 1) > bad || status=$?
[ $status = 1 ]
grep -q '^wang1  *all .*MISSED' bad

# The study of layer 1, for one part in one stock: the make file, the figures, and a figure missed.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-grind)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/layer1.mk B="$build" LAYER1="$PWD/all" PARTS=2 FACTORS=1.5 > table
[ "$(grep -c reached table)" = 2 ]
misses() { # the table ends with 1
    local status=0
    (cd "$root" && pipelines/layer1-table "$OLDPWD/all" 2 1.5) > bad || status=$?
    [ $status = 1 ]
}
jq '.coverings = 3' all/2/1.5/feed.json > worse.json
mv worse.json all/2/1.5/feed.json
misses
grep -q 'feed .*MISSED: too often' bad
# Force beyond its limit, and out of its range.
jq '.coverings = 1 | .peak_force = 17.3' all/2/1.5/feed.json > worse.json
mv worse.json all/2/1.5/feed.json
jq '.contact_time = 9 | .in_range = 0.79' all/2/1.5/force.json > worse.json
mv worse.json all/2/1.5/force.json
misses
grep -q 'feed .*MISSED: too much force' bad
grep -q 'force .*79% .*MISSED: force out of range' bad

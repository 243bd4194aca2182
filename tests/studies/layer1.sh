# The study of layer 1, for one part in one stock: the make file, the figures, and a figure missed.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-grind)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/layer1.mk B="$build" LAYER1="$PWD/all" PARTS=2 FACTORS=1.5 > table
[ "$(grep -c reached table)" = 2 ]
jq '.coverings = 3' all/2/1.5/feed.json > worse.json
mv worse.json all/2/1.5/feed.json
status=0
(cd "$root" && pipelines/layer1-table "$OLDPWD/all" 2 1.5) > bad || status=$?
[ $status = 1 ]
grep -q 'feed .*MISSED: too often' bad

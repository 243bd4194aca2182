# The blade from its patches to the picture: its displacements are the allowance that its stock was given, every ray meets the stock once,
# and the table tells when they are not. Of a mesh (a box in metres) it takes the same way. Reference: the allowance.
# shellcheck source=tests/fettle-surfel/box.bash
. "$HERE/../fettle-surfel/box.bash"
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-surfel)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/belt.mk B="$build" BELT="$PWD/out" SPACING=1 > table
grep -q '^blade ' table
for file in work.pcd errors.pcd surface.pcd rows.pcd errors.png; do test -s out/blade/$file; done
jq -e '.gouge == 0 and .within == 0 and .undercut == .count' out/blade/errors.json > ok
# rows no more than 2 mm apart over 60 mm, each around the blade, 70 mm
jq -e '.passes >= 30 and .passes <= 33 and .length > 30 * 65 and .longest_step <= 0.5' out/blade/rows.json > ok
jq '.min = 0.1' out/blade/work.json > worse.json
mv worse.json out/blade/work.json
status=0
"$root/pipelines/belt-table" out/blade > bad || status=$?
test $status = 1
grep -q MISSED bad
box 0 0 0 0.02 0.01 0.005 > box.off
stock box.off --file-units m --least 0.3 --most 0.3 > stock.stl
fettle-surfel box.off --file-units m --stock stock.stl --spacing 1 --report box.json > box.pcd
# its corners go out by 0.3 mm along the mean normals of their facets, so no face does by as much
jq -e '.min > 0.02 and .max < 0.3 and .no_hit == 0' box.json > ok

# The blade from its patches to the page, ground twice: its displacements are the allowance that its stock was given, every ray meets the stock once,
# and the table reports when they are not. A mesh (a box in metres) goes through the same steps. Reference: the allowance.
# shellcheck source=tests/fettle-surfel/box.bash
. "$HERE/../fettle-surfel/box.bash"
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-surfel)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/belt.mk B="$build" BELT="$PWD/out" SPACING=1 STEP=2.5 OVER=3 WHEEL=samples/wheels/crowned_preston.json > table
grep -q '^blade ' table
# Planned feeds leave 95 % of the design's area and more within the tolerance; each patch has its line.
awk '$1 == "all:" { share = $2 } $1 == "patch" { ++patches } END { exit !(share >= 0.95 && patches == 2) }' table
for file in work.pcd errors.pcd surface.pcd rows.pcd once.pcd twice.pcd ground.pcd remains.txt report.html {contact,pressure,removal,three,whole,errors,left,cell}.png; do
    test -s out/blade/$file
done
grep -q 'by the law of Preston' out/blade/report.html
for picture in $(grep -o 'src="[a-z]*.png"' out/blade/report.html | cut -d'"' -f2); do test -s "out/blade/$picture"; done
# Preston's law takes C V_b F t, over either path; few contacts come near the edge of the wheel.
jq -e -n --slurpfile once out/blade/once.json --slurpfile rest out/blade/rest.json '[$once[0] + {force: 10}, $rest[0] + {force: 3}] |
    all(.near_edge <= 5 and (.removed_volume / (3e-5 * 15000 * .force * .time) - 1 | fabs) < 1e-3)' > ok
jq -e -n --slurpfile b out/blade/errors.json --slurpfile a out/blade/left.json '$a[0].rms < 0.2 * $b[0].rms' > ok
test "$(tail -1 out/blade/watch.csv | cut -d, -f5)" = "$(jq .undercut out/blade/left.json)"
jq -e '.gouge == 0 and .within == 0 and .undercut == .count' out/blade/errors.json > ok
# rows no more than 3 mm apart over 60 mm, each around the blade, 70 mm, and two or three on its second, narrow patch
jq -e '.passes >= 22 and .passes <= 24 and .length > 20 * 65 and .longest_step <= 2.5' out/blade/rows.json > ok
jq '.min = 0.1' out/blade/work.json > worse.json
mv worse.json out/blade/work.json
status=0
"$root/pipelines/belt-table" out/blade > bad || status=$?
test $status = 1
grep -q MISSED bad
box 0 0 0 0.02 0.01 0.005 > box.off
stock box.off --file-units m --min 0.3 --max 0.3 > stock.stl
fettle-surfel box.off --file-units m --stock stock.stl --spacing 1 --report box.json > box.pcd
# its faces go out by 0.3 mm, and its edges to where they meet
jq -e '.min > 0.2999 and .max < 0.3001 and .no_hit == 0' box.json > ok

# Wang's way from end to end on his three parts, seed 1: all of each anomaly is ground, nothing is over-ground, form and largest error are within
# what he published. Reference: the parts themselves; Wang 2007, 6.2 (largest error 2.54 mm, flatness 0.899 mm, cylindricity 0.926 mm).
root=$(realpath "$HERE/../..")
build=$(realpath --relative-to="$root" "$(dirname "$(dirname "$(command -v fettle-grind)")")")
unset MAKEFLAGS MFLAGS MAKELEVEL
run=$PWD/chain/1
casting() { make --no-print-directory -s -C "$root" -f pipelines/casting.mk B="$build" CHAIN="$PWD/chain" METHOD=wang "$@"; }
casting "$run"/wang{1,2,3}/errors.pcd "$run/wang1/flatness.json" "$run/wang2/cylindricity.json"
for part in 1 2 3; do
    jq -e '.regions.inside | .undefined == 0 and .max * 25.4 < 2.54 and .p01 * 25.4 > -0.03' "chain/1/wang$part/errors.json"
    jq -e '.finished' "chain/1/wang$part/grind.json"
done
jq -e '.least_squares * 25.4 < 0.899' chain/1/wang1/flatness.json
jq -e '.least_squares * 25.4 < 0.926' chain/1/wang2/cylindricity.json
# his methods: a plane and its published shift, his section curve, griddata through 16 touches, 4 corners and 4 estimated points
jq -es 'map(.shape.type) == ["plane", "swept", "griddata"] and .[0].shift == 0.005 and (.[2].touches | length) == 24' chain/1/wang{1,2,3}/desired.json
status=0
make --no-print-directory -s -C "$root" -f pipelines/casting.mk METHOD=else demo 2>message || status=$?
[ $status = 2 ]
grep -F 'METHOD is default, wang or adaptive, not else' message

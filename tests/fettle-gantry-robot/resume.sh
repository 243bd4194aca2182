# A run is continued where the part lay when it began: another --place is refused by its name, and none at all. Reference: the change made here.
# shellcheck source=tests/fettle-gantry-robot/stock.bash
. "$HERE/stock.bash"
make_job 30
make_stock 2
make_place 25
common=(--stock stock.stl --cell 0.2 -q -o ground.pcd)
driver=(--gantry "exec:fettle-gantry-robot $ROBOT plan.json --stock stock.stl --cell 0.2")
jq '.bounds.coverings = 2' plan.json >short.json
fettle-grind short.json "${common[@]}" "${driver[@]}" --place place.txt --trace begun.pcd || [ $? = 1 ]
cp begun.pcd kept.pcd
awk 'NR == 1 { $4 += 1 } { print }' place.txt >moved.txt
"$HERE/../refuses" 'begun.pcd: does not match this plan and these options: another --place' fettle-grind plan.json "${common[@]}" "${driver[@]}" --place moved.txt --resume begun.pcd
"$HERE/../refuses" 'begun.pcd: does not match this plan and these options: another --place' fettle-grind plan.json "${common[@]}" --resume begun.pcd
cmp begun.pcd kept.pcd

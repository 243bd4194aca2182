# Where the cutter goes below the box nothing is left: cells are counted and no triangle covers them. Reference: the area
# of a disc of 8 mm, to a row of cells.
printf '10 10 20\n10 10 -1\n' > drill.xyz
fettle-mill drill.xyz --stock box:0,0,0,20,20,5 --cutter flat:8 --step 0.1 --report report.json --pcd --ascii > left.pcd
jq -e '(.cells_without_material / 5026.5 - 1 | fabs) < 0.01 and
       (.removed_volume - 5 * 0.01 * .cells_without_material | fabs) < 1e-6' report.json > ok
awk '/^DATA/ { body = 1; next } body && ($1 - 10) ^ 2 + ($2 - 10) ^ 2 < 15.9 { bad++ } body && $3 != 5 { bad++ } END { exit bad > 0 }' left.pcd

# The study of F_min and F_max, for one wheel and metal: the make file, the table, what the constants mean, and a wheel without a range.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-grind)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
make --no-print-directory -s -C "$root" -f pipelines/forces.mk B="$build" FORCES="$PWD/all" WHEELS=thin METALS=carbon_steel MAX_FORCES='5 20 80' SHARES=0.3 > table
# The rim of 1 in at 12000 rpm runs at 31919 mm/s; 0.4 of the force at 14 J/mm³ is 0.91196 mm³/(N s) or 2.4755e-4 in³/(lbf s).
jq -e '(.removal.coefficient / 2.4755e-4 - 1 | fabs) < 1e-4 and .force.min == 6 and .force.down == 13' all/thin/carbon_steel/20/0.3.job > job
# 2.2 kW at that speed bear 172 N, 38.7 lbf: 20 lbf are held, 80 lbf are not, by the spindle or by the wheel of 60 lbf.
grep -q '^thin  *carbon_steel  *6.0  *20.0 .*80: \(stops\|too much for the wheel\)' table
[ "$(wc -l < all/runs.csv)" = 4 ]
# At 5 lbf the height of one step up a wall is a good part of the force, and what the drives overshoot at a turn is more than all of it.
grep -q '^peaks of the runs that finish: at most 1[01][0-9][.][0-9] % of F_max$' table
jq '.peak_force = 61' all/thin/carbon_steel/20/0.3.json > worse.json
mv worse.json all/thin/carbon_steel/20/0.3.json
status=0
(cd "$root" && pipelines/forces-table "$OLDPWD/all" samples/studies/forces.json thin carbon_steel '20 80' 0.3) > bad || status=$?
[ $status = 1 ]
grep -q '^thin .*MISSED' bad
grep -q '^peaks .*MISSED' bad

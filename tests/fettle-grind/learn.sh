# What a gantry learns from run to run. A stock that is removed 1.4 times as easily as its job says: the coefficient is learnt within 5 %, the next part
# takes less time than without, and is not ground deeper; its passes are predicted. On the last the wheel is half as sharp, which is said. A run is resumed
# with what it knew.
# References: the simulated machine's law; the same parts without learning.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
grind() { # NAME FACTOR OPTION…
    fettle-grind plan.json --stock stock.stl --cell 0.1 --removal-factor "$2" --ascii --report "$1.json" "${@:3}" > "$1.pcd"
}
grind alone 1.4
grind first 1.4 --learn law.json
cmp alone.pcd first.pcd
jq -e '.learnt | .known == 0 and .passes >= 3 and (.coefficient / 1.4 - 1 | fabs) < 0.05 and .spread < 0.1' first.json > ok
cp law.json once.json
grind second 1.4 --learn law.json
grind third 1.4 --learn law.json
jq -e '.learnt | .known >= 6 and .judged == .passes and .covered >= .judged - 1 and .changes == 0' third.json > ok
jq -e --slurpfile alone alone.json '.machine_time < $alone[0].machine_time' second.json > ok
lowest() { awk '/^DATA/ { body = 1; next } body && $1 > -6 && $1 < 6 && $2 > -6 && $2 < 6 && (!n++ || $3 < z) { z = $3 } END { print z }' "$1"; }
awk -v a="$(lowest alone.pcd)" -v b="$(lowest second.pcd)" 'BEGIN { exit !(b >= a - 0.005) }'
grind blunt 0.7 --learn law.json 2> warning
grep -q 'the wheel is blunt or loaded' warning
jq -e '.learnt.changes > 0' blunt.json > ok
# A run is continued with what it knew.
cp once.json known.json
grind part 1.4 --learn known.json --trace part-trace.pcd
"$HERE/../refuses" '--learn' fettle-grind plan.json --stock stock.stl --cell 0.1 --resume part-trace.pcd
# The file is fettle-calibrate's: the same run learnt after the fact.
fettle-grind plan.json --stock stock.stl --cell 0.1 --removal-factor 1.4 --trace trace.pcd > ground.pcd
fettle-calibrate trace.pcd --job job.json --cell 0.1 --before stock.stl -q | jq '{p: .learnt.passes, c: .learnt.gantry.coefficient}' > after.json
jq '{p: .learnt.passes, c: 1.4}' once.json | fettle-diff - after.json --rel 0.05
# A belt's law is none of a gantry's.
fettle-calibrate "$SAMPLES/removal/static.csv" -o belt.json
"$HERE/../refuses" 'belt.json: is the law of a belt' fettle-grind plan.json --stock stock.stl --learn belt.json
# A law that cannot be written is refused before the part is ground.
"$HERE/../refuses" 'missing/law.json: cannot write' fettle-grind plan.json --stock stock.stl --gantry 'exec:touch begun' --learn missing/law.json
[ ! -e begun ]

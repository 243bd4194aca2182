# The wheel wears by the grinding ratio of the job's wheel, which the plan hands on with its source.
# References: the job's own ratio; without one the wheel wears as with 60.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
cp plan.json default.json
for ratio in 60 2; do
    jq --argjson g $ratio '.wheel += {grinding_ratio: $g, source: "chosen"}' job.json > worn-job.json
    fettle-plan worn-job.json surface.json > plan$ratio.json
    jq -e --argjson g $ratio '.job.wheel | .grinding_ratio == $g and .source == "chosen"' plan$ratio.json > ok
    fettle-grind plan$ratio.json --stock stock.stl --cell 0.1 --trace trace$ratio.pcd --report $ratio.json > $ratio.pcd
done
fettle-grind default.json --stock stock.stl --cell 0.1 --trace trace.pcd > ground.pcd
cmp trace.pcd trace60.pcd
cmp ground.pcd 60.pcd
# The wheel's volume, π w (R² - r²), at its last touch-off: no more than what was ground off by then over the ratio, and most of it.
jq -e '(3.14159265 * 2 * (100 - (.wheel_radius | . * .))) * 2 / .removed_volume | . > 0.5 and . < 1.02' 2.json > ok

# The removed volume converges as the cell is halved. Reference: the finest; the differences shrink.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 0
make_stock 4
for cell in 0.4 0.2 0.1 0.05; do
    fettle-grind plan.json --stock stock.stl --cell $cell --report report.json > ground.pcd
    jq .removed_volume report.json
done | jq -e -s '(.[0] - .[3] | fabs) as $a | (.[1] - .[3] | fabs) as $b | (.[2] - .[3] | fabs) as $c |
    $a < 0.01 * .[3] and $b < $a and $c < $b' > ok

# One thread and two write the same bytes. Reference: each other.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/stock.bash"
make_job 30
make_stock 4
for n in 1 2; do fettle-grind plan.json --stock stock.stl --threads $n --trace trace$n.pcd > ground$n.pcd; done
cmp ground1.pcd ground2.pcd
cmp trace1.pcd trace2.pcd

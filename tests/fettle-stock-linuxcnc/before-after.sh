# A stock that no machine has touched is the part as it is, nothing removed; what is no such stock, or another's, is refused.
# Reference: the points of the virtual gantry's stock.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
make_job 30
make_stock 1
fettle-stock-linuxcnc plan.json --stock stock.stl --cell 0.2 > before
fettle-stock-linuxcnc plan.json --stock stock.stl --cell 0.2 --after before > after.pcd
fettle-gantry-virtual plan.json --stock stock.stl --cell 0.2 --ground ground.pcd <<< '1 status' > answer
fettle-diff after.pcd ground.pcd
"$HERE/../refuses" 'before: is not the stock of this part' fettle-stock-linuxcnc plan.json --stock stock.stl --cell 0.1 --after before
"$HERE/../refuses" 'is no stock of a simulated head' fettle-stock-linuxcnc plan.json --stock stock.stl --after stock.stl
head -c 1000 before > short
"$HERE/../refuses" 'is cut short' fettle-stock-linuxcnc plan.json --stock stock.stl --after short
"$HERE/../refuses" '--stock is required' fettle-stock-linuxcnc plan.json

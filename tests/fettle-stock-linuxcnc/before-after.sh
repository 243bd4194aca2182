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
# Reading is bounded by the size of the file, not by its header.
claims() { head -c 14 before; perl -e 'print pack("d<2", @ARGV)' "$@"; tail -c +31 before; }
claims 30000 30000 > many
claims 1e300 1e300 > most
claims nan 5 > none
claims 2.5 4 > part
{ cat before; echo more; } > long
refused() { ( ulimit -v 4000000; "$HERE/../refuses" "$1" fettle-stock-linuxcnc plan.json --stock stock.stl --cell 0.2 --after "$2" ); }
refused 'many: is cut short' many
refused 'most: is cut short' most
refused 'none: is no stock' none
refused 'part: is no stock' part
refused 'long: goes on after its last cell' long
refused 'nowhere: cannot open: No such file' nowhere
refused '.: is no stock' .

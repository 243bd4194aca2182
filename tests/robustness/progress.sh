# On a terminal work that takes longer than a second shows how far it is; elsewhere, or with -q, it does not. A driver that waits before its
# first move makes it long.
# shellcheck source=tests/fettle-grind/stock.bash
. "$HERE/../fettle-grind/stock.bash"
command -v script > /dev/null || { echo 'script (bsdutils) is not installed' >&2; exit 77; }
make_job 0
make_stock 1
cat > slow << 'END'
fettle-gantry-virtual plan.json --stock stock.stl --cell 0.4 | { for i in 1 2 3; do read -r line; echo "$line"; done; sleep 1.2; cat; }
END
grind="fettle-grind plan.json --stock stock.stl --gantry 'exec:bash slow'"
script -qec "$grind -o ground.pcd" /dev/null < /dev/null > shown
tr '\r' '\n' < shown | grep -qE '^grinding \[#* *\] [0-9]+ %$'
script -qec "$grind -o ground.pcd -q" /dev/null < /dev/null > shown
[ ! -s shown ]
bash -c "$grind" > ground.pcd 2> shown
[ ! -s shown ]

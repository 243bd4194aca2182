# Touches saved by adaptive probing, on three cells of a sphere: the program, the make file, the table's figures.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v probing)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
study() { make --no-print-directory -C "$root" -f pipelines/probing.mk B="$build" CELLS=3 SURFACES=sphere_convex OTHERS= PROBING="$PWD/all" "$@"; }
study -s "$PWD/all/sphere_convex.csv"
# Wang's layout by two fits, 17 shares of his touches, and where adaptive stops, for each cell.
test "$(grep -c ^sphere_convex all/sphere_convex.csv)" -eq $((3 * 20))
test "$(cut -d, -f4 all/sphere_convex.csv | grep -cE '^(stopped|exhausted)$')" -eq 3
# A cell is the same in every batch. Reference: the first two by themselves.
probing sphere_convex 2 1 | cmp - <(head -n 41 all/sphere_convex.csv)

# The table's figures. Reference: bands that are 3/4 sqrt(n'/n) of that of n' touches of Wang's layout, so (3/4)^2 of the
# touches do; griddata's are 5 times as wide, more than any share has; 19 of 20 stop within the predicted band. ln band is
# linear between shares to 1e-3.
mkdir exact
awk -v OFS=, 'BEGIN {
    print "kind,cell,wang,design,touches,band,predicted"
    for (cell = 0; cell < 20; ++cell) {
        all = 100; wide = 0.001 * (1 + cell)
        print "plane", cell, all, "wang", all, wide, "nan"
        print "plane", cell, all, "griddata", all, 5 * wide, "nan"
        for (share = 20; share <= 100; share += 5) print "plane", cell, all, "adaptive" share, share, 0.75 * wide * sqrt(100 / share), wide
        print "plane", cell, all, "stopped", 12, cell == 7 ? 0.006 : 0.004, 0.005
    }
}' >exact/plane.csv
"$root/pipelines/probing-table" exact plane '' | tail -n 1 | grep -x 'too few cells: 20 of a kind, 100 decide'
export MIN_CELLS=20
"$root/pipelines/probing-table" exact plane '' >exact.txt
grep -E '^together +11.00 +55.00 +8.25 +0.56 +< 0.20 +12.0 +95.0$' exact.txt
grep -c reached exact.txt | grep -x 4
# A design that Wang's beats is missed.
awk -F, -v OFS=, '$4 ~ /adaptive/ { $6 *= 2 } { print }' exact/plane.csv >worse.csv
mkdir worse && mv worse.csv worse/plane.csv
status=0
"$root/pipelines/probing-table" worse plane '' >worse.txt || status=$?
test $status -eq 1
grep -E 'wang, auto +more  0 to 0.8  MISSED' worse.txt

# The margin on real surfaces: cells cut from two scans, the make file, where cells are cut, the table's figures.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v scans)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
study() { make --no-print-directory -s -C "$root" -f pipelines/scans.mk B="$build" CELLS=2 SCANS="$PWD/all" NAMES='hammer panel' "$@"; }
study >few.txt
grep -x 'too few cells: 1000 decide' few.txt
for name in hammer panel; do
    # each cell by Wang's layout and by default, which touches no less, on the same surface, with the scan by the same touches; 99 % need more
    # than 90 %
    awk -F, '$2 == "wang" { layout = $3 } $2 == "extended" && $3 < layout { exit 1 } $2 ~ /scan/ && ($3 != touches || $11 != band) { exit 1 }
        NR > 1 && !($11 > 0 && $13 > $12 && $18 >= 0 && $18 <= 1) { exit 1 } { touches = $3; band = $11 } END { exit NR != 9 }' "all/$name.csv"
done
# Another margin with the scan, but where the surface is a process, which has waves of its own.
awk -F, '$2 ~ /scan/ && $13 != shift { ++differ } { shift = $13 } END { exit !(differ > 0) }' all/*.csv
# A cell is the same in every batch, and by one strategy alone. Reference: the first one by itself.
scans "$SAMPLES/scans/hammer.stl" mm 8 20 1 1 wang | cmp - <(head -n 2 all/hammer.csv)

# Scans that nothing was chosen by take the place of the others. A plane of 60 x 60 mm, its points 0.5 mm apart, with lines in the header that are none of a PLY's.
mkdir apart
awk 'BEGIN {
    print "ply\nformat ascii 1.0\nbye\nbye\nelement vertex 14641\nproperty float x\nproperty float y\nproperty float z\nend_header"
    for (i = 0; i <= 120; ++i) for (j = 0; j <= 120; ++j) print i * 0.0005, j * 0.0005, 0
}' >apart/happyStandRight_0.ply
study APART="$PWD/apart" SCANS="$PWD/unseen" NAMES=happy STRATEGIES=wang >unseen.txt
awk -F, 'NR > 1 { exit !($5 >= 6 && $5 <= 20 && $22 < 1e-6) }' unseen/happy.csv
grep -cE '^(happy|all) +wang +2 ' unseen.txt | grep -x 2
if grep '^others' unseen.txt; then exit 1; fi
# They are read again from a folder of another name, and from no other.
touch begin
study APART="$PWD/apart" SCANS="$PWD/unseen" NAMES=happy STRATEGIES=wang | cmp - unseen.txt
if test unseen/happy.csv -nt begin; then exit 1; fi
mkdir steeper
awk 'NF == 3 && /^[0-9]/ { $3 = $1 / 8 } { print }' apart/happyStandRight_0.ply >steeper/happyStandRight_0.ply
study APART="$PWD/steeper" SCANS="$PWD/unseen" NAMES=happy STRATEGIES=wang >steeper.txt
test unseen/happy.csv -nt begin
grep -v bye steeper/happyStandRight_0.ply | cmp - unseen/happy.ply

# Cells are cut where the scan knows the part. A plane of 90 x 90 mm in lines along y, DX apart, its points 2 mm apart along them.
lines() { # DX
    awk -v dx="$1" 'BEGIN {
        n = int(90 / dx)
        for (i = 0; i <= n; ++i) for (j = 0; j <= 45; ++j) printf "v %g %g 0\n", i * dx, 2 * j
        for (i = 0; i < n; ++i) for (j = 1; j <= 45; ++j) { a = 46 * i + j; print "f", a, a + 46, a + 1 "\nf", a + 1, a + 46, a + 47 }
    }'
}
lines 2.5 >fine.obj
scans fine.obj mm 14 16 1 1 wang | awk -F, 'NR > 1 { exit !($22 < 1e-9) }'
lines 7.5 >coarse.obj
status=0
scans coarse.obj mm 14 16 1 1 wang >none.csv 2>none.txt || status=$?
test $status -eq 1
grep -x 'no face of this size' none.txt
# As if it were a cloud: a square of a quarter of B without a point
awk '$1 == "v" { print $2, $3, $4 }' coarse.obj >coarse.xyz
status=0
scans coarse.xyz mm 14 16 1 1 wang >none.csv 2>none.txt || status=$?
test $status -eq 1
grep -x 'no face of this size' none.txt

# A strip is left out. Reference: by hand, triangles of which none has a corner within 2 of the line x = 4, y = 0 to 4, one of them upside down.
printf '%s\n' '4 0' '4 4' >line.txt
printf 'v %s 0\n' '0 0' '1 0' '0 1' '3 0' '4 9' '5 8' '9 2' '9 3' '8 2' >strip.obj
printf 'f %s\n' '1 2 3' '1 4 3' '5 2 6' '7 8 9' '9 8 7' '2 7 8' >>strip.obj
"$root/pipelines/mesh-without" line.txt 2 strip.obj | grep '^f' >left.txt
printf 'f %s\n' '1 2 3' '5 2 6' '7 8 9' '2 7 8' | cmp - left.txt

# The table's figures. Reference: 200 cells, two of them over-ground, 95 of a hundred within their bands; Wilson's interval of 2 in 200 by R's prop.test.
mkdir exact
for name in a b; do
    awk -v OFS=, 'BEGIN {
        print "cell,strategy,touches,accuracy,a,b,d,method,weight,goodness,band,shift90,shift99,below90,below99,predicted,covered,points,p99,smooth99,smooth90,skin,usual_skin"
        for (cell = 0; cell < 100; ++cell) for (k = 0; k < 2; ++k)
            print cell, k ? "extended" : "wang", 16 + 4 * k, 0.127, 9, 9, 3, "plane", 1, 0.5, 0.2, 0.1, 0.15, -0.1, (cell < 2 ? 0.01 : -0.1), (cell < 95 ? 0.2 : 0.1), 0.95, 0.002, -0.1, (cell == 7 ? 0.01 : -0.1), (cell < 10 ? 0.01 : -0.1), 0.01, 0.02
    }' >exact/$name.csv
done
table() { MIN_CELLS=${cells:-200} "$root/pipelines/scans-table" "$1" 'a b' "${2-}" 'wang extended'; }
table exact >exact.txt
grep -E '^all +extended +200 +0.020 +20 +0.200 +0.150 +0.200 +1.00 +0.27 to +3.57 +10.00 +2.00 +0.200 +95.0  over 0.5 to 1.5: reached, an edge of the range lies in the interval$' exact.txt
grep -x 'all figures reached' exact.txt
# A cell with a hole in B is not judged.
cp -r exact hole
awk -F, -v OFS=, '$1 == 5 { $1 = 100; $20 = $21 = "-nan"; print }' exact/a.csv >>hole/a.csv
table hole | cmp - exact.txt
# Scans that nothing was learnt on are judged by themselves.
cells=100 table exact b >others.txt
grep -E '^others +wang +100 .*: reached' others.txt
# Two of a hundred are too many.
cp -r exact worse
awk -F, -v OFS=, '$1 < 2 && $2 == "wang" { $20 = 0.02 } { print }' exact/a.csv >worse/a.csv
status=0
table worse >worse.txt || status=$?
test $status -eq 1
grep -x '1 figures missed' worse.txt

# The study of real scans, with parts in their place: the start poses, the make file, the verdict.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-align)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
mkdir scans
fettle-part "$SAMPLES/parts/hammer.json" >part.stl
fettle-align part.stl --to part.stl --near --iterations 0 --ascii | awk 'data { if (n++ % 9 == 0) print $1 / 1000, $2 / 1000, $3 / 1000 } $1 == "DATA" { data = 1 }' >scans/shape1_10000.pcd
for scan in 0deg 60deg 90deg; do awk 'NR % 3 == 0' scans/shape1_10000.pcd >scans/shape1_${scan}_filtered.pcd; done
study() { make --no-print-directory -C "$root" -f pipelines/align.mk B="$build" DATA="$PWD/scans" STARTS=2 ALIGN="$PWD/$1" -s; }
study all >all.out
test "$(grep -c reached all.out)" -eq 4

# A random rotation is one, and numbers differ. Reference: its inverse is its transpose.
"$root/pipelines/random-transform" 1 2 >1.txt
"$root/pipelines/random-transform" 2 2 >2.txt
! cmp -s 1.txt 2.txt || exit 1
awk 'NR < 4 { for (k = 1; k <= 3; k++) m[NR, k] = $k; if ($4 > 2 || $4 < -2) exit 1 }
    END { for (i = 1; i <= 3; i++) for (j = 1; j <= 3; j++) { s = 0; for (k = 1; k <= 3; k++) s += m[i, k] * m[j, k]
        if ((s - (i == j))^2 > 1e-28) exit 1 } }' 1.txt

# One registration in another place is a figure missed.
jq '.overlap = 0.9 | .converged = true' all/0deg/1.json >worse.json
mv worse.json all/0deg/1.json
status=0
"$root/pipelines/align-table" all 2 0deg 60deg 90deg >bad.out || status=$?
test $status -eq 1
grep -qE '^0deg +2 +1 .*MISSED' bad.out
test "$(grep -c MISSED bad.out)" -eq 1

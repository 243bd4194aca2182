# Seven surfels against [-0.1, 0.2]: the bounds are within, the colours step by the range's width, and what has no displacement
# is counted. Exit 0 only if all are within. Reference: by hand.
header() {
    printf 'VERSION .7\nFIELDS x y z normal_x normal_y normal_z displacement\nSIZE 4 4 4 4 4 4 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH %s\nHEIGHT 1\nPOINTS %s\nDATA ascii\n' "$1" "$1"
}
{ header 7; i=0; for d in -0.5 -0.3 -0.1 0.2 0.4 0.6 nan; do echo "$((i++)) 0 0 0 0 1 $d"; done; } > work.pcd
status=0
fettle-assess work.pcd --lower -0.1 --upper 0.2 --ascii --report report.json > errors.pcd 2> warning || status=$?
test $status = 1
grep -q '1 of 7 surfels have no displacement' warning
jq -e '.gouge == 2 and .undercut == 2 and .undefined == 1 and .count == 6 and .within == 1 / 3 and .lower == -0.1 and .upper == 0.2 and
       .min == -0.5 and .max == 0.6 and .max_at == [5, 0, 0]' report.json > ok
sed -n '/^DATA/,$p' errors.pcd
{ header 2; printf '0 0 0 0 0 1 -0.1\n1 0 0 0 0 1 0.2\n'; } | fettle-assess --lower -0.1 --upper 0.2 > right.pcd
refused() { "$HERE/../refuses" "$@"; }
refused '--lower and --upper must be given' fettle-assess work.pcd --lower 0
refused '--lower: 0.3 is more than --upper, 0.2' fettle-assess work.pcd --lower 0.3 --upper 0.2
grep -v displacement work.pcd | sed '1,$!d' > broken.pcd
refused 'broken.pcd' fettle-assess broken.pcd --lower -1 --upper 1
printf '1 2 3\n4 5 6\n' > points.xyz
refused 'points.xyz: no field displacement' fettle-assess points.xyz --lower -1 --upper 1

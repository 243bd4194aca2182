# An organised scan keeps its rows and columns: what a filter takes away leaves NaN at its place, the fields stay, and what is left
# is bit for bit what is left without them. Reference: the same filters without --keep-organised.
awk 'BEGIN { printf "VERSION .7\nFIELDS x y z intensity\nSIZE 8 8 8 8\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 40\nHEIGHT 30\nVIEWPOINT 0 0 0 -1 0 0 0\nPOINTS 1200\nDATA ascii\n"
    for (j = 0; j < 30; j++) for (i = 0; i < 40; i++) {
        if (i == 7 && j < 5) print "nan nan nan", j * 40 + i
        else print i * 0.5, j * 0.5, (i == 20 && j == 11) ? 40 : 0.01 * sin(i * j), j * 40 + i } }' > grid.pcd
filters="--outliers statistical:8,3 --crop box:-1,-1,-50,15,20,50"
# shellcheck disable=SC2086 # words
fettle-clean grid.pcd $filters --report loose.json --ascii -o loose.pcd
# shellcheck disable=SC2086
fettle-clean grid.pcd $filters --keep-organised --report kept.json --ascii -o kept.pcd
cmp loose.json kept.json
jq -e '.invalid == 5 and .outliers > 0 and .cropped > 0' kept.json
grep -q '^WIDTH 40$' kept.pcd
grep -q '^HEIGHT 30$' kept.pcd
sed '1,/^DATA/d' kept.pcd | grep -v '^nan' > left
sed '1,/^DATA/d' loose.pcd | cmp - left
sed '1,/^DATA/d' kept.pcd | awk '$4 != NR - 1 { exit 1 }'
# A mesh through its rows leaves what was taken away open.
fettle-reconstruct kept.pcd -q -o kept.stl
"$HERE/../refuses" '--keep-organised: the cloud has no rows and columns' fettle-clean loose.pcd --keep-organised

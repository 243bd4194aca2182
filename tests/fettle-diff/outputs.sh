# An output appears whole or not at all; a failed write is an error; a reader that leaves early is none. By hand.
p="$HERE/two-points.pcd"
fails() { local status=0; "$@" 2> stderr || status=$?; test $status = 2; test "$(wc -l < stderr)" = 1; }
fails fettle-diff "$p" "$p" -o no/where
fails fettle-diff "$p" "$p" -o .
fails fettle-diff "$p" "$p" -o /dev/full
fails fettle-diff "$p" "$p" -o ''
fails fettle-diff "$p" "$p" -o both --report both
fails fettle-diff "$p" nowhere -o never
fails fettle-diff "$p" "$p" --report no/where
fails bash -c 'fettle-diff "$0" "$0" > /dev/full' "$p"
fails bash -c 'fettle-diff "$0" "$0" >&-' "$p"
test ! -e never && test ! -e both
fettle-diff --help | head -n 1 > /dev/null
cp "$p" same.pcd
fails fettle-diff same.pcd same.pcd -o same.pcd
cmp "$p" same.pcd
fettle-diff "$p" "$p" -o /dev/null
fettle-diff "$p" "$p" -q -o out.txt --report report.json
test "$(echo *)" = "out.txt report.json same.pcd stderr"

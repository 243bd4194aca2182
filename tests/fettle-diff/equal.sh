# A file equals itself, NaN included, and a difference is counted, measured and placed. Reference: by hand.
test "$(fettle-diff "$HERE/two-points.pcd" - < "$HERE/two-points.pcd")" = '0 of 15 values differ'
sed 's/^4 5 6/4 5.25 6/' "$HERE/two-points.pcd" > moved.pcd
status=0; fettle-diff "$HERE/two-points.pcd" moved.pcd > said || status=$?
test $status = 1
test "$(cat said)" = '1 of 15 values differ; largest difference 0.25 at point 1, y: 5 against 5.25'
fettle-diff --tol 0.25 "$HERE/two-points.pcd" moved.pcd
fettle-diff --rel 0.05 "$HERE/two-points.pcd" moved.pcd
! fettle-diff --rel 0.04 "$HERE/two-points.pcd" moved.pcd || exit 1

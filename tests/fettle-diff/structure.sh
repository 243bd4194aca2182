# What cannot be compared is reported: fields, number of points, units, kind. Reference: by hand.
differs() { local status=0; fettle-diff --tol 100 "$HERE/two-points.pcd" other.pcd || status=$?; test $status = 1; }
sed 's/error/sigma/' "$HERE/two-points.pcd" > other.pcd; differs
sed 's/units mm/units in/' "$HERE/two-points.pcd" > other.pcd; differs
sed 's/WIDTH 2/WIDTH 1/; s/HEIGHT 1/HEIGHT 2/' "$HERE/two-points.pcd" > other.pcd; differs
sed 's/WIDTH 2/WIDTH 1/; s/POINTS 2/POINTS 1/; $d' "$HERE/two-points.pcd" > other.pcd; differs
echo '{"points": 2}' > other.pcd; differs

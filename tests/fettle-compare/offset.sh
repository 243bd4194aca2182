# Points over and under a plate. Reference: their heights. The fields of the test stay, the normal is the plate's.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n' >plate.obj
cat >test.pcd <<'PCD'
VERSION .7
FIELDS x y z layer
SIZE 4 4 4 4
TYPE F F F I
COUNT 1 1 1 1
WIDTH 4
HEIGHT 1
VIEWPOINT 1 2 3 1 0 0 0
POINTS 4
DATA ascii
1 1 0.5 7
5 5 -0.25 8
9 2 0 9
2 8 0.25 10
PCD
fettle-compare test.pcd --to plate.obj --ascii --report report.json >errors.pcd
grep -q '^FIELDS x y z layer normal_x normal_y normal_z error rgb$' errors.pcd
grep -q '^VIEWPOINT 1 2 3 1 0 0 0$' errors.pcd
sed '1,/^DATA/d' errors.pcd | cut -d ' ' -f 1-8
jq -e '.count == 4 and .undefined == 0 and .mean == 0.125 and .mean_abs == 0.25 and .min == -0.25 and .max == 0.5 and
    .band == 0.75 and .p50 == 0.125 and .within == null' report.json >/dev/null

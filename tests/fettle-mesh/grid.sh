# Grids over a plane: number of points and triangles, heights, alignment with W, the touches' box without a job.
# Reference: by hand. The anomaly is 2 x 1, turned with the frame by atan(3/4).
cat >surface.json <<'JSON'
{"kind": "surface", "units": {"length": "mm"},
 "shape": {"type": "plane", "origin": [0, 0], "z0": 1, "slope": [0.5, 0]}, "shift": 0.25,
 "touches": [[0, 0, 1, 1], [2, 0, 2, 1], [1, 1, 1.5, 1]]}
JSON
echo '{"kind": "job", "units": {"length": "mm"}, "frame": {"theta_deg": 36.86989764584402}, "surface": {"type": "plane"},
  "anomaly": [[0, 0], [1.6, 1.2], [1.0, 2.0], [-0.6, 0.8]]}' >job.json
pcd() {
    printf 'VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n' "$1" "$1"
    cat
}
pcd 6 >turned.pcd <<'POINTS'
0 0 1.25
0.8 0.6 1.65
1.6 1.2 2.05
-0.6 0.8 0.95
0.2 1.4 1.35
1.0 2.0 1.75
POINTS
fettle-mesh surface.json --step 1 --within job.json | fettle-diff --tol 1e-6 turned.pcd -
pcd 6 >box.pcd <<'POINTS'
0 0 1.25
1 0 1.75
2 0 2.25
0 1 1.25
1 1 1.75
2 1 2.25
POINTS
fettle-mesh --step 1 <surface.json | fettle-diff --tol 1e-6 box.pcd -
# Two triangles a cell: 50 bytes each after a header of 84. Their heights are the plane's.
fettle-mesh surface.json --step 0.25 --stl >plane.stl
test "$(stat -c %s plane.stl)" = $((84 + 50 * 2 * 8 * 4))
fettle-compare box.pcd --to plane.stl --report report.json >/dev/null
jq -e '.count == 6 and .max < 1e-6 and .min > -1e-6' report.json

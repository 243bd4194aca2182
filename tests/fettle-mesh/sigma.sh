# Height and its standard deviation at given points, in their order. Reference: by hand, variance = 0.04 + 0.01 x^2 for
# a plane of which z0 and the slope in x are uncertain; outside a spline's rectangle both are unknown.
cat >plane.json <<'JSON'
{"kind": "surface", "units": {"length": "mm"},
 "shape": {"type": "plane", "origin": [0, 0], "z0": 1, "slope": [0.5, 0]}, "covariance": [0.04, 0, 0.01, 0, 0, 0]}
JSON
header() {
    printf 'VERSION 0.7\nFIELDS x y z%s\nSIZE 4 4 4%s\nTYPE F F F%s\nCOUNT 1 1 1%s\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA ascii\n' \
        "${1:-}" "${1:+ 4}" "${1:+ F}" "${1:+ 1}"
}
{ header && printf '4 9 99\n0 0 99\n-2 5 nan\n'; } >at.pcd
{ header ' sigma' && printf '4 9 3 0.4472136\n0 0 1 0.2\n-2 5 0 0.28284271\n'; } >expected.pcd
fettle-mesh plane.json --at at.pcd --sigma | fettle-diff --tol 1e-6 expected.pcd -
fettle-mesh - --at at.pcd --sigma <plane.json | fettle-diff --tol 1e-6 expected.pcd -
cat >spline.json <<'JSON'
{"kind": "surface", "units": {"length": "mm"},
 "shape": {"type": "bspline", "angle_deg": 0, "origin": [-1, -1], "cell": [2, 2],
           "heights": [[7, 7, 7, 7], [7, 7, 7, 7], [7, 7, 7, 7], [7, 7, 7, 7]]}}
JSON
{ header && printf '4 9 nan\n0 0 7\n-2 5 nan\n'; } >expected.pcd
fettle-mesh spline.json --at at.pcd | fettle-diff --tol 1e-6 expected.pcd -

# Wang's modified tensor B-spline: a bicubic on a grid of as many points comes back (exact reference: the formula; 3e-6 in
# covers single precision), estimated points are used, and its file reads back. Nonsense is refused.
source "$HERE/points.bash"
job freeform >job.json
formula='1 + 0.2 * x ^ 3 - 0.1 * x * y - 0.3 * y ^ 2 * x'
awk "BEGIN { for (i = 0; i < 25; ++i) { x = i % 5 * 0.75 - 1.5; y = int(i / 5) * 0.75 - 1.5
    printf \"%.9f %.9f %.9f %d\\n\", x, y, $formula, i % 2 ? 3 : 1 } }" | pcd x y z role >grid.pcd
fettle-fit job.json grid.pcd --method bspline-wang --report report.json -o surface.json
jq -e '.touches == 25 and .ignored == 0 and .rms < 1e-6' report.json
jq -e '.shape.type == "tensor-bspline" and (.shape.heights | length) == 5 and (.shape.knots_u | length) == 9' surface.json
heights "$formula" 60 2 | pcd x y z >truth.pcd
fettle-mesh surface.json --at truth.pcd | fettle-diff --tol 3e-6 truth.pcd -
bad() { # CHANGE MESSAGE
    jq "$1" surface.json >bad.json
    "$HERE/../refuses" "bad.json: shape.$2" fettle-mesh bad.json --at truth.pcd
}
bad '.shape.knots_u[4] = 2' 'knots_u: must ascend, the first and the last 4 the same'
bad '.shape.knots_v += [9, 9]' 'knots_v: there are 11 for 5 control heights'
heights 1 3 1 | touches >three.pcd
"$HERE/../refuses" 'three.pcd: a bspline-wang fit needs at least 4 touches, got 3' fettle-fit job.json three.pcd --method bspline-wang
for i in 1 2 3 4 5; do echo "$i $i $i"; done | touches >line.pcd
"$HERE/../refuses" 'line.pcd: touches lie on one line in x and y' fettle-fit job.json line.pcd --method bspline-wang

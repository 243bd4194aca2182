# The covariance of an interpolant holds the touches' noise, not what it misses between them: neither a margin nor a sigma is made of
# it. Reference: the errors on a patch, of which nearly all exceed two of such sigmas.
part=patch_concave_2x2
job=$SAMPLES/jobs/$part.json
fettle-part "$SAMPLES/parts/$part.json" >part.stl
fettle-sample "$job" --on part.stl --strategy wang | fettle-estimate "$job" >points.pcd
for method in griddata bspline-wang; do
    fettle-fit "$job" points.pcd --method $method >$method.json
    "$HERE/../refuses" "the covariance of an interpolant ($method) holds the touches' noise" fettle-mesh $method.json --step 0.2 --sigma
    fettle-mesh $method.json --step 0.2 >grid.pcd
done
"$HERE/../refuses" "the covariance of an interpolant (bspline-wang) holds the touches' noise" fettle-margin "$job" bspline-wang.json

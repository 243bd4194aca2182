# The whole chain gives the same bytes with one thread and with two. Reference: each other.
job=$SAMPLES/jobs/wang3.json
jq '.step = 0.05' "$SAMPLES/parts/wang3.json" >part.json
for n in 1 2; do
    mkdir $n
    fettle-part part.json --threads $n >$n/part.stl
    fettle-sample "$job" --on $n/part.stl --noise normal:0.005 --threads $n >$n/samples.pcd
    fettle-estimate "$job" $n/samples.pcd --threads $n >$n/points.pcd
    fettle-fit "$job" $n/points.pcd --threads $n >$n/surface.json
    fettle-margin "$job" $n/surface.json --threads $n >$n/desired.json
    fettle-mesh $n/desired.json --step 0.1 --within "$job" --sigma --threads $n >$n/grid.pcd
    fettle-plan "$job" $n/desired.json --threads $n >$n/plan.json
    fettle-grind $n/plan.json --stock $n/part.stl --cell 0.04 --trace $n/trace.pcd --threads $n >$n/ground.pcd
    fettle-compare $n/ground.pcd --to $n/part.stl --within "$job" --threads $n >$n/errors.pcd || test $? -eq 1
    fettle-form sphericity $n/samples.pcd --threads $n >$n/form.json
    fettle-render $n/errors.pcd --within "$job" --threads $n >$n/errors.png
done
diff -r 1 2

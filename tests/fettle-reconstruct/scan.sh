# The hammer's vertices become the hammer again: points of virtual scans of it, with 0.02 mm of noise, lie on the mesh as well as on the hammer itself. The
# same bytes for any number of threads; fields go into the PLY.
fettle-align "$SAMPLES/scans/hammer.stl" --to "$SAMPLES/scans/hammer.stl" --near --iterations 0 --ascii | sed '1,/^DATA/d' | awk '{ print $1, $2, $3, NR }' > points.xyz
for threads in 1 3; do fettle-reconstruct points.xyz --threads $threads --max-gap 8 --report $threads.json -o $threads.ply; done
cmp 1.ply 3.ply
cmp 1.json 3.json
head -c 400 1.ply | grep -a -q 'column4'
jq -e '.order == "none" and .left_out < 20 and .triangles > 19000' 1.json > ok
for view in 1 2; do
    fettle-place "$SAMPLES/scans/views/$view.pcd" --matrix "$SAMPLES/scans/views/$view.txt" -o placed.pcd
    fettle-compare placed.pcd --to 1.ply --report mesh.json -o mesh.pcd
    fettle-compare placed.pcd --to "$SAMPLES/scans/hammer.stl" --report hammer.json -o hammer.pcd
    jq -e --slurpfile hammer hammer.json '.rms < 1.3 * $hammer[0].rms and .count > 0.99 * $hammer[0].count' mesh.json > ok
done

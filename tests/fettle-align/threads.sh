# Any number of threads writes the same bytes, for a mesh and for a cloud as reference.
jq --arg scan "$SAMPLES/scans/hammer.stl" '.scan.file = $scan | .step = 1' "$SAMPLES/parts/hammer.json" | fettle-part - >part.stl
fettle-align part.stl --to part.stl --near --iterations 0 -o cloud.pcd
for reference in "$SAMPLES/scans/hammer.stl" cloud.pcd; do
    for threads in 1 3; do
        fettle-align part.stl --to $reference --threads $threads --iterations 5 --report $threads.json -o $threads.pcd -q || test $? -eq 1
    done
    cmp 1.pcd 3.pcd
    cmp 1.json 3.json
done

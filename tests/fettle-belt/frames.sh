# Pictures of surfels while they are ground: as many as asked for. Reference: the trace's end.
printf 'OFF\n4 2 0\n0 0 0\n30 0 0\n30 30 0\n0 30 0\n3 0 1 2\n3 0 2 3\n' >plate.off
fettle-surfel plate.off --stock plate.off --spacing 2 -o work.pcd
awk 'BEGIN { print "x y z qw qx qy qz"; for (i = 0; i < 12; i++) print 6 + 1.5 * i, 15, 0, 1, 0, 0, 0 }' >path.xyz
cp "$SAMPLES/wheels/rubber_preston.json" wheel.json
fettle-belt work.pcd --path path.xyz --wheel wheel.json --force 5 --feed 5 --cells 16 --lower -0.001 --upper 0.001 --watch watch.csv --frames 4 --frames-in f --trace trace.csv -o ground.pcd -q
jq -e '.kind == "frames" and (.frames | length) == 4' f/frames.json >/dev/null
end=$(tail -n 1 trace.csv | cut -d , -f "$(head -n 1 trace.csv | tr , '\n' | grep -nx t | cut -d : -f 1)")
jq -e --argjson last "$end" '(.frames[3].t - $last | fabs) < 1e-4' f/frames.json >/dev/null
! cmp -s f/001.png f/004.png || exit 1
# Without a range in the colours of the displacements.
fettle-belt work.pcd --path path.xyz --wheel wheel.json --force 5 --feed 5 --cells 16 --frames 2 --frames-in g -o ground.pcd -q
jq -e '.frames | length == 2' g/frames.json >/dev/null
! cmp -s g/001.png g/002.png || exit 1
! cmp -s g/002.png f/004.png || exit 1
# A folder that cannot be made; anyone but root is told so before the part is ground.
"$HERE/../refuses" '/proc/pictures: no folder for pictures: ' fettle-belt work.pcd --path path.xyz --wheel wheel.json --force 5 --feed 5 --cells 16 \
    --frames 2 --frames-in /proc/pictures -o ground.pcd

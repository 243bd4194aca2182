# A mesh is aligned as one where -o asks for STL or PLY, its fields included; its vertices are those of the PCD. Reference: the motion that it was given.
fettle-part "$SAMPLES/parts/hammer.json" -o part.stl
fettle-place part.stl --turn x,40,z,110 --transform-out there.txt --inverse back.txt -o away.ply
fettle-align away.ply --to "$SAMPLES/scans/hammer.stl" --transform-in back.txt --iterations 0 -o back.stl
fettle-diff --tol 3e-5 back.stl part.stl
fettle-align away.ply --to "$SAMPLES/scans/hammer.stl" --transform-in back.txt --iterations 0 -o back.ply
fettle-align away.ply --to "$SAMPLES/scans/hammer.stl" --transform-in back.txt --iterations 0 -o back.pcd
grep -a -q '^element face 47546' back.ply
head -c 6 back.pcd | grep -q PCD
grep -a -q "^POINTS 23824" back.pcd

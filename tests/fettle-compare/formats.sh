# Every format gives the same error map. Reference: the heights of four points over a plate, by hand.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n' >plate.obj
printf 'x y z layer\n1 1 0.5 7\n5 5 -0.25 8\n9 2 0 9\n12 8 0.25 10\n' >test.xyz
compare() { fettle-compare test.xyz --to plate.obj --tolerance 0.5 "$@"; }
compare --format csv
# A first line with the numbers of vertices and faces, as in FCL's test files, changes nothing.
{ echo '4 1'; cat plate.obj; } >counted.obj
fettle-compare test.xyz --to counted.obj --tolerance 0.5 --format csv | cmp - <(compare --format csv)
# PLY: fettle reads back the contents of the PCD; the header has the names that CloudCompare expects.
compare -o errors.pcd
compare --format ply -o errors.ply
grep -a -c -E '^property (float (nx|scalar_error|scalar_layer)|uchar red)$' errors.ply
fettle-compare errors.ply --to plate.obj --ascii | sed '1,/^DATA/d' | cut -d ' ' -f 1-4,8
[ "$(tail -c +"$((1 + $(grep -a -b end_header errors.ply | cut -d : -f 1) + 11))" errors.ply | wc -c)" -eq $((4 * (3 * 4 + 8 + 4 * 4 + 3))) ]
# Legacy VTK: big-endian arrays one after the other.
compare --format vtk -o errors.vtk
grep -a -E '^(POINTS|VERTICES|POINT_DATA|SCALARS|COLOR_SCALARS|NORMALS)' errors.vtk
at=$(grep -a -b '^LOOKUP_TABLE' errors.vtk | head -n 1 | cut -d : -f 1)
tail -c +$((at + 22)) errors.vtk | head -c 12 | od -An -t x1
status=0
fettle-compare test.xyz --to plate.obj --format ply --ascii >out 2>err || status=$?
[ $status -eq 2 ]
[ ! -s out ]
cat err

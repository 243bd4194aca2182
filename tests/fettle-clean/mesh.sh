# A mesh keeps its triangles, its vertices' fields and its unit, and is written in the format that the suffix asks for. Reference: a box by hand.
cat > box.ply <<'PLY'
ply
format ascii 1.0
element vertex 9
property float x
property float y
property float z
property float scalar_heat
element face 8
property list uchar int vertex_indices
end_header
0 0 0 10
2 0 0 20
2 2 0 30
0 2 0 40
0 0 1 50
2 0 1 60
2 2 1 70
0 2 1 80
nan 0 0 90
4 3 2 1 0
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
4 4 5 6 7
3 0 1 8
PLY
fettle-clean box.ply --file-units in --report report.json -o all.ply 2> said
grep -q 'box.ply: 1 facet with NaN or infinite corners left out' said
jq -e '.points == 8 and .triangles == 14 and .duplicates == 2 and .triangles_left == 12 and .points_left == 8' report.json > ok
fettle-clean all.ply --file-units in --facing 0,0,1 --report report.json -o top.ply
jq -e '.facing_away == 10 and .triangles_left == 2 and .points_left == 4' report.json > ok
grep -a -c -E '^(element vertex 4|property float scalar_heat|element face 2|property list uchar int vertex_indices)' top.ply > lines
[ "$(cat lines)" = 4 ]
# The fields of the four corners on top.
fettle-diff top.ply <(fettle-clean all.ply --crop box:-1,-1,0.5,3,3,3 --format ply)
python3 - top.ply > heats <<'PYTHON'
import struct, sys
data = open(sys.argv[1], "rb").read()
body = data[data.index(b"end_header\n") + 11:]
print(*[int(struct.unpack_from("<4f", body, 16 * i)[3]) for i in range(4)])
print(*[struct.unpack_from("<B3i", body, 64 + 13 * i) for i in range(2)])
PYTHON
printf '50 60 70 80\n(3, 3, 0, 1) (3, 1, 2, 3)\n' | cmp - heats
# STL, from stdout or by its suffix; the same triangles.
fettle-clean top.ply > top.stl
fettle-clean top.ply -o also.STL
cmp top.stl also.STL
fettle-diff top.stl top.ply
# Without its lid and what touches it: triangles go with their corners.
fettle-clean all.ply --crop box:-1,-1,-1,1,3,3 --report report.json -o side.stl
jq -e '.cropped == 4 and .triangles_left == 2' report.json > ok

# A part is moved with its triangles, fields, normals and viewpoint, and back. Reference: points laid by hand.
cat > flag.ply <<'PLY'
ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property float nx
property float ny
property float nz
property float scalar_heat
element face 1
property list uchar int vertex_indices
end_header
0 0 0 1 0 0 10
2 0 0 1 0 0 20
2 1 0 1 0 0 30
0 1 5 1 0 0 40
4 0 1 2 3
PLY
# x to y, then y to z: what was x is z.
fettle-place flag.ply --turn z,90,x,90 -o turned.ply --inverse back.txt --transform-out there.txt
fettle-align turned.ply --to turned.ply --near --iterations 0 --ascii | sed '1,/^DATA/d' > turned
awk 'function is(a, b) { d = a - b; return d < 1e-6 && d > -1e-6 }
     { split("0 0 0 2 0 0 2 1 0 0 1 5", p); x = p[3 * NR - 2]; y = p[3 * NR - 1]; z = p[3 * NR]
       if (!is($1, -y) || !is($2, -z) || !is($3, x)) { print "line " NR ": " $0; bad = 1 } } END { exit bad || NR != 4 }' turned
grep -a -c -E '^(element face 2|property float (nx|ny|nz|scalar_heat))' turned.ply > lines
[ "$(cat lines)" = 5 ]
python3 - turned.ply > values <<'PYTHON'
import struct, sys
data = open(sys.argv[1], "rb").read()
body = data[data.index(b"end_header\n") + 11:]
for i in range(4): print(*[round(v) for v in struct.unpack_from("<7f", body, 28 * i)[3:]])
PYTHON
printf '0 0 1 10\n0 0 1 20\n0 0 1 30\n0 0 1 40\n' | cmp - values
fettle-place turned.ply --matrix back.txt | fettle-diff --tol 1e-6 - <(fettle-clean flag.ply)
fettle-place flag.ply --matrix there.txt --format ply | cmp - turned.ply

# A matrix of fettle-align moves a cloud as fettle-align does, in every unit; the viewpoint too.
fettle-place "$SAMPLES/scans/panel.pcd" --turn x,30,y,-50 --transform-out T.txt -o place.pcd
sed -i '1s/[^ ]*$/0.25/' T.txt
fettle-place "$SAMPLES/scans/panel.pcd" --matrix T.txt -o place.pcd
fettle-align "$SAMPLES/scans/panel.pcd" --to "$SAMPLES/scans/panel.pcd" --transform-in T.txt --iterations 0 -q -o align.pcd
cmp place.pcd align.pcd
# In millimetres: the same part, and its reader knows.
fettle-place "$SAMPLES/scans/panel.pcd" --matrix T.txt --units mm -o mm.pcd
grep -a -q '^# units mm' mm.pcd
fettle-place mm.pcd --units m | fettle-diff --tol 1e-6 - place.pcd
# The middle of its box comes to the origin.
fettle-place mm.pcd --centre -o centred.pcd
fettle-clean centred.pcd --ascii | sed '1,/^DATA/d' |
    awk 'NR == 1 { for (k = 1; k <= 3; k++) a[k] = b[k] = $k } { for (k = 1; k <= 3; k++) { if ($k < a[k]) a[k] = $k; if ($k > b[k]) b[k] = $k } }
        END { for (k = 1; k <= 3; k++) if (a[k] + b[k] > 0.001 || a[k] + b[k] < -0.001) exit 1 }'

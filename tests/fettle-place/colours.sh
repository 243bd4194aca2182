# A colour comes back from PLY as the one field it was: PCD → PLY → PCD has the same bytes, and a PLY's red, green and blue are drawn as the
# PCD's rgb, of points and of a mesh. Three channels that are no bytes, or of which one is missing, stay fields of their own. Reference: the PCD.
awk 'BEGIN { for (y = 0; y < 20; ++y) for (x = 0; x < 20; ++x) print x, y, 0.125 * (x % 3), (x * 65536 + y * 2560 + 77) % 16777216, x + y }' >rows
{ printf '# .PCD v0.7\n# units mm\nVERSION 0.7\nFIELDS x y z rgb sigma\nSIZE 4 4 4 4 4\nTYPE F F F U F\nCOUNT 1 1 1 1 1\nWIDTH 400\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 400\nDATA ascii\n'; cat rows; } >drawn.pcd
fettle-place drawn.pcd -o as.ply
fettle-place as.ply -o once.pcd
grep -a -q '^FIELDS x y z rgb sigma$' once.pcd
fettle-diff drawn.pcd once.pcd
fettle-place once.pcd -o again.ply
cmp as.ply again.ply
fettle-place again.ply | cmp - once.pcd
for tool in 'fettle-render --field rgb' 'fettle-view --field rgb,sigma'; do
    $tool - <drawn.pcd >pcd.out
    $tool - <as.ply | cmp - pcd.out
done
# a mesh whose vertices have colours, before their normals as MeshLab writes them
mesh() { # TYPE SCALE
    printf 'ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty %s red\nproperty %s green\nproperty %s blue\nproperty uchar alpha\n' "$1" "$1" "$1"
    printf 'property float nx\nproperty float ny\nproperty float nz\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n'
    for corner in '0 0' '30 0' '30 30' '0 30'; do echo "$corner 0 $2 255 0 0 1"; done
    printf '3 0 1 2\n3 0 2 3\n'
}
mesh uchar '255 128 0' >orange.ply
fettle-render orange.ply --field rgb -o orange.png
PYTHONPATH=$HERE/../fettle-render python3 - <<'PYTHON'
from png import pixels
rows = pixels(open("orange.png", "rb").read())
assert rows[len(rows) // 2][400] == (255, 128, 0), rows[len(rows) // 2][400]
PYTHON
mesh float '1 0.5 0' >floats.ply
"$HERE/../refuses" "no field 'rgb'" fettle-render floats.ply --field rgb -o none.png
fettle-render floats.ply --field green -o green.png
sed '/^property uchar blue$/d; s/ 255 128 0 255 / 255 128 255 /' orange.ply >two.ply
fettle-render two.ply --field green -o green.png

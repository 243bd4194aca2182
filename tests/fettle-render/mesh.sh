# A mesh is a shaded surface with its walls, and shows the fields of its vertices. References: a box whose left half has an error of +0.1
# and whose right half one of -0.1, seen from above and from the front; a decoder of PNGs in python.
python3 - <<'PYTHON'
corners = [(x, y, z, 0.1 if x < 20 else -0.1, -1 if x < 20 else 1) for x in (0, 19.999, 20.001, 40) for y in (0, 30) for z in (0, 25)]
def at(i, j, k): return 4 * i + 2 * j + k
faces = []
def quad(a, b, c, d): faces.extend([(a, b, c), (a, c, d)])
for i in range(3):
    quad(at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 1, 1), at(i, 1, 1))   # top
    quad(at(i, 0, 0), at(i, 1, 0), at(i + 1, 1, 0), at(i + 1, 0, 0))   # bottom
    quad(at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1))   # front
    quad(at(i, 1, 0), at(i, 1, 1), at(i + 1, 1, 1), at(i + 1, 1, 0))   # back
quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0))
quad(at(3, 0, 0), at(3, 1, 0), at(3, 1, 1), at(3, 0, 1))
with open("box.ply", "w") as f:
    f.write("ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\nproperty float error\nproperty float class\n"
            "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (len(corners), len(faces)))
    f.writelines("%g %g %g %g %g\n" % c for c in corners)
    f.writelines("3 %d %d %d\n" % t for t in faces)
PYTHON
fettle-render box.ply -o top.png
fettle-render box.ply --from 0,-1,0.4 -o front.png
fettle-render box.ply --from 0,-1,0.4 --field z -o shaded.png
fettle-render box.ply --field class -o class.png
PYTHONPATH=$HERE python3 - <<'PYTHON'
from png import pixels
ground = (228, 228, 232)
def shown(name):
    rows = pixels(open(name, "rb").read())
    part = [[c for c in row[90:980]] for row in rows[40:-130]]
    inside = [(y, [x for x, c in enumerate(row) if c != ground]) for y, row in enumerate(part)]
    inside = [(y, xs) for y, xs in inside if len(xs) > 200]
    return part, inside
def cell(part, inside, share_y, share_x):
    y, xs = inside[int(share_y * (len(inside) - 1))]
    return part[y][xs[int(share_x * (len(xs) - 1))]]
part, inside = shown("top.png")
left, right = cell(part, inside, 0.5, 0.25), cell(part, inside, 0.5, 0.75)
assert left[2] > left[0] + 50 and right[0] > right[2] + 50, (left, right)
part, inside = shown("front.png")       # the wall below the top: the same colours
left, right = cell(part, inside, 0.8, 0.25), cell(part, inside, 0.8, 0.75)
assert left[2] > left[0] + 30 and right[0] > right[2] + 30, (left, right)
part, inside = shown("shaded.png")      # lit from above: the wall is darker than the top
top, wall = cell(part, inside, 0.1, 0.5), cell(part, inside, 0.6, 0.5)
assert sum(top) != sum(wall) and wall != ground, (top, wall)
part, inside = shown("class.png")
left, right = cell(part, inside, 0.5, 0.25), cell(part, inside, 0.5, 0.75)
assert left[0] > left[2] + 60 and right[2] > right[0] + 60, (left, right)   # gouge, undercut
PYTHON
"$HERE/../refuses" 'box.ply: ' fettle-render box.ply --field pressure -o none.png

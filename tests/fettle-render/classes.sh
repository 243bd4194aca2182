# Classes and colours are drawn as such: of three stripes of surfels each has its class's colour, the legend names and counts them; with
# the inspection palette red and blue change sides; `rgb` is what the points say. References: the stripes, a decoder of PNGs in python.
awk 'BEGIN { for (y = 0.5; y < 30; ++y) for (x = 0.5; x < 30; ++x) { c = int(x / 10) - 1; print x, y, 0, c, c < 0 ? 1193046 : 65280 } }' >rows
{ printf '# .PCD v0.7\n# units mm\nVERSION 0.7\nFIELDS x y z class rgb\nSIZE 4 4 4 4 4\nTYPE F F F F U\nCOUNT 1 1 1 1 1\nWIDTH 900\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 900\nDATA ascii\n'; cat rows; } >stripes.pcd
fettle-render stripes.pcd --field class -o class.png
fettle-render stripes.pcd --field class --palette inspection -o inspection.png
fettle-render stripes.pcd --field rgb -o rgb.png
PYTHONPATH=$HERE python3 - <<'PYTHON'
from png import pixels
def cells(name):
    rows = pixels(open(name, "rb").read())
    width, height = 900, len(rows)
    middle = rows[height // 2 - 40]
    ground = [x for x in range(84, 984) if middle[x] != (228, 228, 232)]
    return [middle[ground[0] + (ground[-1] - ground[0]) * k // 6] for k in (1, 3, 5)], rows
(gouge, within, undercut), rows = cells("class.png")
assert gouge[0] > gouge[2] + 60 and undercut[2] > undercut[0] + 60 and within == (150, 200, 120), (gouge, within, undercut)
# the legend has a box of each colour
legend = {c for row in rows for c in row[1000:1060]}
assert {gouge, within, undercut} <= legend
(gouge, within, undercut), _ = cells("inspection.png")
assert gouge[2] > gouge[0] + 60 and undercut[0] > undercut[2] + 60, (gouge, within, undercut)
(left, middle, right), _ = cells("rgb.png")
assert left == (0x12, 0x34, 0x56) and middle == right == (0, 255, 0), (left, middle, right)
PYTHON
# patches have five classes
sed 's/^FIELDS x y z class rgb/FIELDS x y z class d/; s/^TYPE F F F F U/TYPE F F F F F/' stripes.pcd >patches.pcd
fettle-render patches.pcd --field class -o patches.png
! cmp -s patches.png class.png || exit 1
# any other classes, up to twenty, by their numbers
sed '/^DATA/q' stripes.pcd >head
awk '{ print $1, $2, $3, 5 + int($1 / 2), $5 }' rows | cat head - >numbered.pcd
fettle-render numbered.pcd --field class -o numbered.png
! cmp -s numbered.png class.png || exit 1
awk '{ print $1, $2, $3, 5 + int($1), $5 }' rows | cat head - >many.pcd
"$HERE/../refuses" "many.pcd: field 'class' has more than 20 different values" fettle-render many.pcd --field class -o many.png

# The labels beside the bar never run into the histogram, however small or large the errors: between the longest label and the
# histogram's axis the ground is white in every row, and its bars end on the sheet. References: a decoder of PNGs in python; the axis is the
# column with the longest stretch of grey.
printf 'OFF\n4 2 0\n0 0 0\n40 0 0\n40 40 0\n0 40 0\n3 0 1 2\n3 0 2 3\n' >plate.off
awk 'BEGIN { for (y = 0.5; y < 40; ++y) for (x = 0.5; x < 40; ++x) print x, y, 0 }' >flat.xyz
fettle-compare flat.xyz --to plate.off --file-units mm --ascii -o flat.pcd
column=$(sed -n 's/^FIELDS //p' flat.pcd | tr ' ' '\n' | grep -n -x error | cut -d : -f 1)
for size in 1.37e-12 7.77e-7 4.44e-4 98765; do
    awk -v size="$size" -v error="$column" 'seen { $error = size * (NR % 11 - 5) / 5 } /^DATA/ { seen = 1 } { print }' flat.pcd >errors.pcd
    fettle-render errors.pcd -o "errors-$size.png"
    fettle-render errors.pcd --scale "$(awk -v s="$size" 'BEGIN { print s / 3 }')" -o "beyond-$size.png"
done
PYTHONPATH=$HERE python3 - *-*.png <<'PYTHON'
import sys
from png import pixels
white, grey = (255, 255, 255), (170, 170, 170)
names = sys.argv[1:]
assert len(names) == 8
for name in names:
    rows = pixels(open(name, "rb").read())
    width, height = len(rows[0]), len(rows)
    left = 84 + 900 + 40   # of the bar, 40 pixels beside the map
    def run(x):            # the longest stretch of grey in a column
        best = start = 0, 0
        for y in range(height):
            start = (start[0], y + 1) if start and rows[y][x] == grey else (y + 1, y + 1)
            best = max(best, start, key=lambda s: s[1] - s[0])
        return best
    axes = [(x, *run(x)) for x in range(left + 30, width)]
    axis, top, bottom = max(axes, key=lambda found: found[2] - found[1])
    assert bottom - top > 400, (name, axis, top, bottom)
    for y in range(top, bottom):
        assert all(rows[y][x] == white for x in range(axis - 6, axis)), (name, axis, y)
    labels = sum(1 for y in range(top, bottom) for x in range(left + 32, axis) if sum(rows[y][x]) < 300)
    assert labels > 100, (name, labels)   # digits are there
    bars = [max((x for x in range(axis + 1, width) if rows[y][x] != white), default=axis) for y in range(top, bottom)]
    assert axis + 20 < max(bars) < width - 4, (name, axis, max(bars), width)
    # What is said of errors beyond the scale ends on the sheet, too.
    for y in list(range(0, top)) + list(range(bottom, height - 60)):
        assert all(rows[y][x] == white for x in range(width - 4, width)), (name, y)
PYTHON

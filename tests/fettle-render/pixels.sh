# The map of a square plate, its left half 0.1 mm too high and its right half 0.1 mm too low: the step is in the middle, the plate is square, and
# the legend has the two colours where it says 0.1 and -0.1. Reference: a decoder of PNGs in python, and these numbers.
printf 'OFF\n4 2 0\n0 0 0\n40 0 0\n40 40 0\n0 40 0\n3 0 1 2\n3 0 2 3\n' > plate.off
awk 'BEGIN { for (y = 0.25; y < 40; y += 0.5) for (x = 0.25; x < 40; x += 0.5) print x, y, x < 20 ? 0.1 : -0.1 }' |
    fettle-compare - --to plate.off --file-units mm --ascii > errors.pcd
fettle-render errors.pcd -o map.png
PYTHONPATH=$HERE python3 - map.png > measured.json << 'PYTHON'
import json, sys
from png import pixels

rows = pixels(open(sys.argv[1], "rb").read())
# The two halves are the most frequent colours in which blue and red prevail, among pixels of the map, left of the legend at 1000.
count = {}
for row in rows:
    for c in row[:1000]:
        count[c] = count.get(c, 0) + 1
high = max((c for c in count if c[2] > c[0] + 50), key=count.get)
low = max((c for c in count if c[0] > c[2] + 50), key=count.get)
row = max(rows, key=lambda r: sum(c in (high, low) for c in r[:1000]))
left = [x for x, c in enumerate(row[:1000]) if c == high]
right = [x for x, c in enumerate(row[:1000]) if c == low]
width = right[-1] - left[0] + 1
height = sum(1 for r in rows if r[left[0] + 5] == high)
# The legend's bar, from its first coloured row to its last: where is the colour of the left half?
bar = [r[1035] for r in rows[90:670]]
coloured = [i for i, c in enumerate(bar) if max(c) > min(c) + 8]
def place(colour):
    at = min(coloured, key=lambda i: sum(abs(a - b) for a, b in zip(bar[i], colour)))
    return 1 - 2 * (at - coloured[0]) / (coloured[-1] - coloured[0])
print(json.dumps({"left over right": len(left) / len(right), "step": (right[0] - left[0]) / width, "height over width": height / width,
                  "high on the legend": place(high), "low on the legend": place(low)}))
PYTHON
# Two pixels of some hundreds. The legend goes from 0.15 to -0.15 mm; its colours have 8 bits, and the map is shaded lightly.
echo '{"left over right": 1, "step": 0.5, "height over width": 1, "high on the legend": 0.6667, "low on the legend": -0.6667}' | fettle-diff measured.json - --tol 0.03

# The texts of the page's drawings stay apart where they are copied or extracted: each label of a legend, an axis or a chart is a line of
# the drawing's text. References: the standard library's XML reader; the texts that are drawn, one element each.
awk 'BEGIN { for (i = 0; i < 40; i++) for (j = 0; j < 40; j++) print 0.5 * i, 0.5 * j, 0.02 * sin(i / 9) * cos(j / 7) }' >part.xyz
printf 'v -1 -1 0\nv 40 -1 0\nv 40 40 0\nv -1 40 0\nf 1 2 3 4\n' >plate.obj
fettle-compare part.xyz --to plate.obj --tolerance 0.03 --report errors.json -o errors.pcd
fettle-report --errors errors.pcd --comparison errors.json -o page.html
python3 - <<'PYTHON'
import re
import xml.etree.ElementTree as tree
page = open("page.html").read()
drawings = [tree.fromstring(svg) for svg in re.findall(r"<svg.*?</svg>", page, re.S)]
assert len(drawings) >= 2
legends = 0
for drawing in drawings:
    lines = "".join(drawing.itertext()).split("\n")
    drawn = ["".join(text.itertext()) for text in drawing.iter("text")]
    assert [line for line in lines if line] == drawn, (lines, drawn)
    legends += {"error, mm", "material left", "over-cut"} <= set(lines)
assert legends >= 1
PYTHON

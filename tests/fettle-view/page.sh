# A page is well-formed XML, holds all it shows, is the same for any number of threads; its data says how many points and triangles it
# has, and its legend has the range and the colours of the picture. References: libxml2, zlib, the plate's corners, draw's palette.
awk 'BEGIN { for (y = 0.25; y < 40; y += 0.5) for (x = 0.25; x < 40; x += 0.5) print x, y, 0 }' >flat.xyz
printf 'OFF\n4 2 0\n0 0 0\n40 0 0\n40 40 0\n0 40 0\n3 0 1 2\n3 0 2 3\n' >plate.off
awk '{ print $1, $2, $1 < 20 ? 0.1 : -0.1 }' flat.xyz | fettle-compare - --to plate.off --file-units mm -o errors.pcd
fettle-view errors.pcd plate.off --title 'Plate & <steps>' -o view.html
fettle-view errors.pcd plate.off --title 'Plate & <steps>' --threads 1 | cmp - view.html
xmllint --noout --nonet view.html
! sed '/<!\[CDATA\[/,/\]\]>/d' view.html | grep -qiE '<(link|iframe|object|embed)|https?:|@import|url\(' || exit 1
python3 - view.html <<'PYTHON'
import base64, json, re, struct, sys, zlib
page = open(sys.argv[1]).read()
scene = json.loads(re.search(r'class="scene">(.*?)</script>', page, re.S).group(1))
blocks = [zlib.decompress(base64.b64decode(b)) for b in re.findall(r'class="block">(.*?)</script>', page, re.S)]
errors, plate = scene["layers"]
assert (errors["count"], errors["triangles"], plate["count"], plate["triangles"]) == (6400, 0, 4, 2)
field = errors["fields"][0]
assert field["name"] == "error" and field["unit"] == "mm" and abs(field["high"] - 0.1) < 0.051 and field["low"] == -field["high"]
colours = base64.b64decode(field["colours"])
assert tuple(colours[:3]) < (110, 10, 40) and colours[-1] > 90 and len(colours) == 768  # dark red over-cut, dark blue material left
def column(block, at, count):
    value, numbers = 0, []
    for i in range(count):
        value = value + block[at + i] + 256 * block[at + count + i] & 65535
        numbers.append(value)
    return numbers
n = errors["count"]
xs, values = column(blocks[0], 0, n), column(blocks[0], 8 * n, n)  # three coordinates and two bytes of the normal before
for x, value in zip(xs, values):
    x, value = errors["origin"][0] + errors["step"][0] * x, field["origin"] + field["step"] * value
    assert abs(value - (0.1 if x < 20 else -0.1)) < 1e-5, (x, value)
PYTHON
# Of classes the legend says the names, counts and colours, and where a value is looked up there is its colour. A name is text, whatever
# is in it. Reference: the stripes; the colour of "within".
{ printf '# .PCD v0.7\n# units mm\nVERSION 0.7\nFIELDS x y z class\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 900\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 900\nDATA ascii\n'
    awk 'BEGIN { for (y = 0.5; y < 30; ++y) for (x = 0.5; x < 30; ++x) print x, y, 0, int(x / 10) - 1 }'; } >'<&>.pcd'
fettle-view '<&>.pcd' --field class -o classes.html
xmllint --noout --nonet classes.html
python3 - classes.html <<'PYTHON'
import base64, json, re, sys
text = re.search(r'class="scene">(.*?)</script>', open(sys.argv[1]).read(), re.S).group(1)
assert not set("<>&") & set(text), text
layer, = json.loads(text)["layers"]
assert layer["name"] == "<&>.pcd", layer["name"]
field = next(f for f in layer["fields"] if f["name"] == "class")
assert [(c["value"], c["name"], c["count"]) for c in field["classes"]] == [(-1, "gouge", 300), (0, "within", 300), (1, "undercut", 300)]
colours = base64.b64decode(field["colours"])
assert (field["low"], field["high"], len(colours)) == (-1.5, 1.5, 768)
for c in field["classes"]:
    at = int((c["value"] - field["low"]) / 3 * 256)
    assert list(colours[3 * at : 3 * at + 3]) == c["colour"], c
assert field["classes"][1]["colour"] == [150, 200, 120]
PYTHON

# A page of fettle-view in headless Chromium without a GPU: it turns, tells what is under the pointer, cuts a section, and picks corners
# that fettle-teach makes a job of; nothing is requested and no error said. References: the part's own numbers (an error of +0.1 mm left
# of x = 20, -0.1 right of it, over a plate at z = 0), and the job of the same corners typed as CloudCompare lists them.
command -v chromium >/dev/null || { echo 'chromium is not installed' >&2; exit 77; }
awk 'BEGIN { for (y = 0.25; y < 40; y += 0.5) for (x = 0.25; x < 40; x += 0.5) print x, y, x < 20 ? 0.1 : -0.1 }' >steps.xyz
printf 'OFF\n4 2 0\n0 0 0\n40 0 0\n40 40 0\n0 40 0\n3 0 1 2\n3 0 2 3\n' >plate.off
fettle-compare steps.xyz --to plate.off --file-units mm -o errors.pcd
cat >job.json <<'JOB'
{ "kind": "job", "units": {"length": "mm", "force": "N"}, "surface": {"type": "freeform"},
  "anomaly": [[10, 10], [30, 10], [30, 30], [10, 30]], "sampling": [[5, 5], [35, 5], [35, 35], [5, 35]] }
JOB
fettle-view errors.pcd plate.off --within job.json --pick -o view.html
PYTHONPATH=$HERE python3 - view.html <<'PYTHON'
import json, re, sys
from browser import Page

root = "document.querySelector('.fettle-view')"
page = Page(sys.argv[1])
try:
    page.wait(f"{root} && ({root}.dataset.ready || {root}.dataset.error)")
    assert page.value(f"{root}.dataset.error") is None, page.value(f"{root}.dataset.error")
    print("first frame", page.value(f"{root}.dataset.firstFrame"), "ms", file=sys.stderr)
    stage = page.value("(b => [b.left, b.top])(document.querySelector('.stage').getBoundingClientRect())")

    def pixel(point):
        at = page.value(f"{root}.fettleView.camera.project({json.dumps(point)})")
        return stage[0] + at[0], stage[1] + at[1]

    def picture():
        return page.value("(c => { const d = c.getContext('2d'), s = document.querySelector('.stage canvas'); c.width = s.width; c.height = s.height;"
                          "d.drawImage(s, 0, 0); return [...d.getImageData(0, 0, c.width, c.height).data].reduce((h, v) => (h * 31 + v) % 1000003, 7) })"
                          "(document.createElement('canvas'))")

    # hovering tells place, error and region
    def tip(point):
        page.mouse("mouseMoved", *pixel(point))
        return page.wait("(t => !t.hidden && t.textContent)(document.querySelector('.tip'))")
    told = tip([15.25, 15.25, 0.1])
    assert re.search(r"x 15\.\d+  y 15\.\d+  z 0\.1", told) and "error 0.1 mm" in told and "inside B" in told, told
    page.mouse("mouseMoved", *pixel([26, 6.5, -0.1]))
    page.wait("document.querySelector('.tip').textContent.includes('between B and S')")
    assert "error \u22120.1 mm" in page.value("document.querySelector('.tip').textContent")

    # the colours are those of the legend: material left is blue, over-cut red
    def colour(point):
        x, y = page.value(f"{root}.fettleView.camera.project({json.dumps(point)}).slice(0, 2)")
        return page.value("(c => { const d = c.getContext('2d'); c.width = c.height = 1;"
                          f"d.drawImage(document.querySelector('.stage canvas'), -{round(x)}, -{round(y)}); return [...d.getImageData(0, 0, 1, 1).data].slice(0, 3) }})"
                          "(document.createElement('canvas'))")
    page.settle()
    left, cut = colour([12.25, 12.25, 0.1]), colour([26.25, 12.25, -0.1])
    assert left[2] > 80 and left[2] > 1.3 * left[0] and cut[0] > 80 and cut[0] > 1.3 * cut[2], (left, cut)

    # dragging turns it, and only while it is dragged
    before = picture()
    frames = int(page.value(f"{root}.dataset.frames"))
    page.drag((stage[0] + 500, stage[1] + 300), (stage[0] + 700, stage[1] + 200))
    page.wait(f"{root}.dataset.frames > {frames}")
    assert page.value(f"{root}.fettleView.camera.azimuth") < -1
    page.settle()
    assert picture() != before

    # a section across the step: the profile of test and reference
    page.press("Top")
    page.press("Section")
    page.drag(pixel([2, 20, 0]), pixel([38, 20, 0]))
    curves = json.loads(page.wait("document.querySelector('canvas.profile').dataset.curves"))
    assert {c["name"] for c in curves} >= {"test", "reference", "plate.off"}, curves
    shown = page.value(f"{root}.fettleView.curves.filter(c => ['test', 'reference'].includes(c.name)).map(c => c.pieces.flat().map(p => p[1]))")
    reference, test = shown
    assert max(abs(h) for h in reference) < 2e-3 and len(reference) > 60, reference
    assert abs(max(test) - 0.1) < 1e-4 and abs(min(test) + 0.1) < 1e-4
    page.key("Escape")
    assert page.value("document.querySelector('canvas.profile').hidden")

    # corners: added, moved, taken back
    page.press("Top")
    for name, corners in (("Corners of B", [[10, 10], [30, 10], [30, 30], [12, 30], [1, 1]]), ("Corners of S", [[5, 5], [35, 5], [35, 35], [5, 35]])):
        page.press(name)
        for x, y in corners:
            page.click(*pixel([x, y, 0]))
        if name == "Corners of B":
            page.press("Undo")
    page.drag(pixel([12, 30, 0]), pixel([10, 30, 0]))
    picks = page.value("document.querySelector('textarea.picks').value")
    open("picks.txt", "w").write(picks)
    assert re.findall(r"^[BS]\d", picks, re.M) == ["B1", "B2", "B3", "B4", "S1", "S2", "S3", "S4"], picks
    places = [[float(v) for v in line.split(",")[1:]] for line in picks.splitlines() if line[0] in "BS"]
    for (x, y, z), wanted in zip(places, [[10, 10], [30, 10], [30, 30], [10, 30], [5, 5], [35, 5], [35, 35], [5, 35]]):
        assert max(abs(x - wanted[0]), abs(y - wanted[1])) <= 0.51 and abs(z - (0.1 if x < 20 else -0.1)) < 1e-4, (x, y, z)  # a cell

    # another layer by a key, at the same view
    page.key("2", text="2")
    page.wait(f"{root}.fettleView.layer.name === 'plate.off'")
    page.screenshot("wide.png")
    page.resize(500, 800)
    page.settle()
    page.screenshot("narrow.png")
    assert page.value("document.documentElement.scrollWidth") <= 500
    assert page.errors == [] and page.requests == [], (page.errors, page.requests)
finally:
    page.close()
PYTHON
# what was picked makes the job that the same numbers make as CloudCompare lists them
fettle-teach job.json --anomaly picks.txt >picked.json
for boundary in B S; do sed -n "s/^$boundary[0-9]*,//p" picks.txt >$boundary.txt; done
fettle-teach job.json --anomaly B.txt --sampling S.txt | cmp - picked.json

# The index of 500 parts takes at most 5 MB, opens within a second, and is sorted by a click, without a request or an error; and the page of
# a run plays its frames beside the force trace. The bound on time leaves room for a busy machine. References: the size, the clock, the numbers.
command -v chromium >/dev/null || { echo 'chromium is not installed' >&2; exit 77; }
awk 'BEGIN { for (i = 0; i < 60; i++) for (j = 0; j < 60; j++) print 0.5 * i, 0.5 * j, 0.02 * sin(i / 9) * cos(j / 7) + 0.004 * sin(91 * i * j) }' >part.xyz
printf 'v -1 -1 0\nv 40 -1 0\nv 40 40 0\nv -1 40 0\nf 1 2 3 4\n' >plate.obj
fettle-compare part.xyz --to plate.obj --tolerance 0.03 --report errors.json -o errors.pcd
mkdir pages
fettle-report --errors errors.pcd --comparison errors.json --report pages/0.json -o pages/0.html
python3 - <<'PYTHON'
import json
page = json.load(open("pages/0.json"))
for n in range(1, 501):
    page.update(title=f"Part {n}", page=f"{n}.html", worst=0.001 * ((37 * n) % 501), verdict="within" if (37 * n) % 501 <= 30 else "out of tolerance",
                machine_time=60 + n % 7, head=[["serial", f"S{n}"]])
    json.dump(page, open(f"pages/{n}.json", "w"))
PYTHON
rm pages/0.json
fettle-report --index pages/*.json -o index.html
[ "$(stat -c %s index.html)" -le 5000000 ]
echo '{"kind": "part", "units": {"length": "mm"}, "surface": {"type": "plane", "point": [0, 0, 0]}, "region": {"x": [-12, 12], "y": [-12, 12]},
    "step": 1, "anomalies": [{"type": "hill", "centre": [0, 0], "semi_axes": [4, 3], "height": 1}]}' | fettle-part -o stock.stl
echo '{"kind": "job", "units": {"length": "mm", "force": "N"}, "surface": {"type": "plane"}, "tolerance": 0.05, "safe_height": 20,
    "anomaly": [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]], "sampling": [[-10, -10, 0], [10, -10, 0], [10, 10, 0], [-10, 10, 0]]}' >job.json
echo '{"kind": "surface", "units": {"length": "mm"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 0, "slope": [0, 0]}}' | fettle-plan job.json >plan.json
fettle-grind plan.json --stock stock.stl --cell 0.5 --trace trace.pcd --frames 5 --frames-in pictures --report grind.json -o ground.pcd || [ $? = 1 ]
fettle-report --plan plan.json --grinding grind.json --trace trace.pcd --frames pictures/frames.json -o run.html
PYTHONPATH=$HERE python3 - <<'PYTHON'
import json, os, sys
from browser import Page
page = Page("index.html")
try:
    page.wait("document.readyState === 'complete'")
    took = page.value("(e => e.loadEventEnd - e.startTime)(performance.getEntriesByType('navigation')[0])")
    print(f"{os.path.getsize('index.html')} bytes, open after {took:.0f} ms", file=sys.stderr)
    assert took < 10000
    cell = "[...document.querySelectorAll('table.parts tbody tr')].map(row => Number(row.cells[5].dataset.sort))"
    rows = page.value(cell)
    assert len(rows) == 500 and rows != sorted(rows)
    page.press("Worst")
    assert page.value(cell) == sorted(rows)
    page.press("Worst")
    assert page.value(cell) == sorted(rows, reverse=True)
    assert page.value("document.querySelectorAll('.trends figure').length") == 3
    assert page.errors == [] and page.requests == [], (page.errors, page.requests)
    if os.environ.get("SCREENSHOTS"):
        for width in (1400, 500):
            page.resize(width, 900)
            page.screenshot(os.path.join(os.environ["SCREENSHOTS"], f"index-{width}.png"))
finally:
    page.close()
page = Page("run.html")
try:
    page.wait("document.querySelector('.player') && document.querySelector('.player').dataset.shown === '2'")
    # The page itself notes each frame as it is shown: a busy machine may look only when the last one is there again.
    page.value("window.played = []; new MutationObserver(() => played.push(document.querySelector('.player').dataset.shown))"
               ".observe(document.querySelector('.player'), {attributeFilter: ['data-shown']})")
    page.press("\u25b6 Play")
    page.wait("played.length >= 3")
    assert page.value("played") == ["0", "1", "2"], page.value("played")
    ended = [frame["t"] for frame in json.load(open("pictures/frames.json"))["frames"]]
    assert page.value("document.querySelector('.player output').textContent") == f"{ended[-1]:.1f} s"
    # The cursor on the force trace stands where the frame's time does: at last at its end, at first before.
    cursor = "Number(document.querySelector('line.cursor').getAttribute('x1'))"
    x, width, seconds = (float(page.value(f"document.querySelector('rect.time-axis').{get}")) for get in
                         ("getAttribute('x')", "getAttribute('width')", "dataset.seconds"))
    assert abs(page.value(cursor) - (x + min(1, ended[-1] / seconds) * width)) < 1e-6
    page.value("(range => { range.value = 0; range.dispatchEvent(new Event('input')); })(document.querySelector('.player input'))")
    assert abs(page.value(cursor) - (x + ended[0] / seconds * width)) < 1e-6
    assert page.errors == [] and page.requests == [], (page.errors, page.requests)
finally:
    page.close()
PYTHON

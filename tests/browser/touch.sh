# Fingers on a view: one turns the part, two zoom it, a tap tells what is there. And a browser without WebGL shows the picture instead, with
# no error. References: the camera of the view, the part's own error of 0.1 mm, and the picture in the page.
command -v chromium >/dev/null || { echo 'chromium is not installed' >&2; exit 77; }
awk 'BEGIN { for (y = 0.25; y < 40; y += 0.5) for (x = 0.25; x < 40; x += 0.5) print x, y, 0.1 }' >level.xyz
printf 'OFF\n4 2 0\n0 0 0\n40 0 0\n40 40 0\n0 40 0\n3 0 1 2\n3 0 2 3\n' >plate.off
fettle-compare level.xyz --to plate.off --file-units mm -o errors.pcd
fettle-view errors.pcd -o view.html
PYTHONPATH=$HERE python3 - <<'PYTHON'
from browser import Page
root = "document.querySelector('.fettle-view')"
camera = root + ".fettleView.camera"
page = Page("view.html", width=500)
try:
    page.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
    page.wait(f"{root} && {root}.dataset.ready")
    stage = page.value("(b => [b.left, b.top])(document.querySelector('.stage').getBoundingClientRect())")

    def touch(kind, *points):
        page.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": stage[0] + x, "y": stage[1] + y, "id": k} for k, (x, y) in enumerate(points)])
    page.press("Top")
    x, y = page.value(f"{camera}.project([20, 20, 0.1]).slice(0, 2)")
    touch("touchStart", (x, y))
    touch("touchEnd")
    assert "error 0.1 mm" in page.wait("(t => !t.hidden && t.textContent)(document.querySelector('.tip'))")
    azimuth, scale = page.value(f"[{camera}.azimuth, {camera}.scale]")
    touch("touchStart", (150, 200))
    for k in range(1, 9):
        touch("touchMove", (150 + 10 * k, 200))
    touch("touchEnd")
    page.wait(f"{camera}.azimuth < {azimuth} - 0.3")
    assert page.value(f"{camera}.scale") == scale
    azimuth = page.value(f"{camera}.azimuth")
    touch("touchStart", (150, 200), (200, 200))
    for k in range(1, 9):
        touch("touchMove", (150 - 6 * k, 200), (200 + 6 * k, 200))
    touch("touchEnd")
    page.wait(f"{camera}.scale < 0.6 * {scale}")
    assert page.value(f"{camera}.azimuth") == azimuth
    assert page.errors == [] and page.requests == [], (page.errors, page.requests)
finally:
    page.close()
page = Page("view.html", switches=["--disable-3d-apis"])
try:
    page.wait(f"{root} && {root}.classList.contains('without-webgl')")
    shown = page.value("(i => [i.naturalWidth, i.getBoundingClientRect().width > 100, getComputedStyle(document.querySelector('.stage') ?? i).display])(document.querySelector('.fallback img'))")
    assert shown[0] > 500 and shown[1], shown
    assert page.value("[...document.querySelectorAll('.fettle-view canvas')].every(c => c.getBoundingClientRect().width === 0)")
    assert page.requests == [] and not [e for e in page.errors if "WebGL" not in e], (page.errors, page.requests)
finally:
    page.close()
PYTHON

# The page of fettle-report in headless Chromium shows part and errors in a view that can be turned, layers switch at the same view,
# nothing is requested and no error said; where there is no WebGL the pictures stand alone. Reference: the browser.
command -v chromium >/dev/null || { echo 'chromium is not installed' >&2; exit 77; }
fettle-part "$SAMPLES/parts/wang1.json" -o part.stl
fettle-part "$SAMPLES/parts/wang1.json" --without-anomaly -o truth.stl
fettle-compare part.stl --to truth.stl --within "$SAMPLES/jobs/wang1.json" --report errors.json -o errors.pcd || test $? = 1 # out of tolerance
fettle-report --job "$SAMPLES/jobs/wang1.json" --before part.stl --errors errors.pcd --comparison errors.json -o page.html
PYTHONPATH=$HERE python3 - <<'PYTHON'
from browser import Page
root = "document.querySelector('.fettle-view')"
page = Page("page.html", 1400, 1200)
try:
    page.wait(f"{root} && ({root}.dataset.ready || {root}.dataset.error)")
    assert page.value(f"{root}.dataset.error") is None and page.value(f"{root}.classList.contains('with-webgl')")
    page.value(f"{root}.scrollIntoView()")
    assert page.value(f"{root}.fettleView.layer.name") == "errors"
    page.press("before")
    page.wait(f"{root}.fettleView.layer.name === 'before'")
    page.settle()
    page.screenshot("report.png")
    page.resize(500, 900)
    page.settle()
    page.screenshot("report-narrow.png")
    assert page.errors == [] and page.requests == [], (page.errors, page.requests)
finally:
    page.close()
PYTHON

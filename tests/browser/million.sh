# A page of a million points takes at most 12 MB; it tells how long the first picture took and how many frames a second a turning part
# gets on this machine without a GPU. The bounds on these leave room for a machine that is busy. Reference: the size, and the clock.
command -v chromium >/dev/null || { echo 'chromium is not installed' >&2; exit 77; }
python3 - <<'PYTHON'
import array, math, random
random.seed(1)
numbers = array.array("f")
for i in range(1000):
    for j in range(1000):
        error = 0.05 * math.sin(i / 35) * math.cos(j / 45) + random.gauss(0, 0.01)
        numbers.extend((0.2 * i + random.uniform(-0.05, 0.05), 0.2 * j + random.uniform(-0.05, 0.05), 20 * math.sin(i / 300) * math.cos(j / 250) + error, error, 0, 0, 1))
with open("million.pcd", "wb") as file:
    file.write(b"# .PCD v0.7\n# units mm\nVERSION 0.7\nFIELDS x y z error normal_x normal_y normal_z\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\n"
               b"COUNT 1 1 1 1 1 1 1\nWIDTH 1000000\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1000000\nDATA binary\n")
    numbers.tofile(file)
PYTHON
fettle-view million.pcd -o million.html
[ "$(stat -c %s million.html)" -le 12000000 ]
PYTHONPATH=$HERE python3 - <<'PYTHON'
import sys, time
from browser import Page
root = "document.querySelector('.fettle-view')"
page = Page("million.html")
try:
    page.wait(f"{root} && {root}.dataset.ready", 120)
    first = int(page.value(f"{root}.dataset.firstFrame"))
    time.sleep(2)
    rate = page.value("""new Promise(done => {
        const root = document.querySelector('.fettle-view'), canvas = root.querySelector('canvas'), gl = canvas.getContext('webgl2'), byte = new Uint8Array(4);
        const send = (kind, x) => canvas.dispatchEvent(new PointerEvent(kind, { pointerId: 1, clientX: x, clientY: 400, button: 0, bubbles: true, pointerType: 'mouse' }));
        canvas.setPointerCapture = () => {};
        send('pointerdown', 300);
        let count = 0, start;
        const step = now => {
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, byte); // the frame before is finished
            if (count === 20) start = performance.now();              // by then the number of points has been chosen
            send('pointermove', 300 + 3 * ++count);
            if (!(performance.now() - start > 4000)) requestAnimationFrame(step);
            else { send('pointerup', 300); done((count - 20) / (performance.now() - start) * 1000); }
        };
        requestAnimationFrame(step);
    })""")
    print(f"{first} ms to the first frame, {rate:.1f} frames/s", file=sys.stderr)
    assert page.errors == [] and page.requests == [], (page.errors, page.requests)
    assert first < 30000 and rate > 1
finally:
    page.close()
PYTHON

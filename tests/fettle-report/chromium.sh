# Headless Chromium shows the page without a complaint and prints it on A4: a handful of pages, none of them empty.
# Reference: the browser. The pages carry everything, so the network is not used (the missing proxy would fail).
command -v chromium >/dev/null || { echo 'chromium is not installed' >&2; exit 77; }
. "$HERE/run.bash"
page --title 'Part 1: what headless Chromium makes of it' -o page.html
export HOME=$PWD
browse() {
    timeout 120 chromium --headless --no-sandbox --disable-gpu --proxy-server=127.0.0.1:9 --hide-scrollbars \
        --user-data-dir="$PWD/profile" --enable-logging=stderr --v=0 "$@" "file://$PWD/page.html" >dom 2>log
}
# What the browser says of its own software renderer is no complaint about the page.
complaints() { grep -i 'CONSOLE' log | grep -vE 'software WebGL has been deprecated|GL Driver Message \(OpenGL, Performance'; }
browse --window-size=1000,4000 --screenshot=shot.png
test -s shot.png
! complaints || exit 1
browse --no-pdf-header-footer --print-to-pdf=page.pdf
! complaints || exit 1
pages=$(grep -ac '/Type /Page$' page.pdf)
echo "$pages pages" >&2
test "$pages" -ge 3 && test "$pages" -le 8
test "$(grep -ac '/MediaBox \[0 0 59[45][^ ]* 84[12]' page.pdf)" -eq "$pages"

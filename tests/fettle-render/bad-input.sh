# What cannot be drawn: exit 2, one line on stderr, no picture. One point is a picture.
refused() { # PATTERN ARGUMENT…
    pattern=$1 status=0
    shift
    fettle-render "$@" -o x.png >out 2>err </dev/null || status=$?
    [ $status -eq 2 ] && [ ! -s out ] && [ ! -e x.png ] && [ "$(wc -l <err)" -eq 1 ] && grep -q "^fettle-render: .*$pattern" err ||
        { echo "not refused as expected: $* (status $status)"; cat err; exit 1; }
}
pcd() { # ROW…
    printf '# .PCD v0.7\n# units mm\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n' $# $#
    [ $# -eq 0 ] || printf '%s\n' "$@"
}
pcd '1 2 3' >one.pcd
fettle-render one.pcd -o one.png && [ -s one.png ]
pcd '1 2 nan' '2 3 nan' >undefined.pcd # nothing to show but where: grey
fettle-render undefined.pcd -o undefined.png
pcd 'nan nan nan' 'nan nan nan' >nan.pcd
refused 'nan.pcd: .*nothing to draw' nan.pcd
pcd >empty.pcd
refused 'empty.pcd' empty.pcd
refused 'stdin: empty, expected points or a mesh' -
refused "one.pcd: .*'error'" one.pcd --field error
refused "one.pcd: .*'forse'" one.pcd --field forse
refused '.in' one.pcd --file-units in
refused 'nowhere.pcd' nowhere.pcd
echo 'not a picture' >text
refused 'text' text
refused 'kind' one.pcd --within "$SAMPLES/parts/wang1.json"
fettle-part "$SAMPLES/parts/wang1.json" -o part.stl
refused "part.stl: .*'error'" part.stl --field error
refused '.scale' one.pcd --scale 0
refused '.bands' one.pcd --bands -1
refused '.bands' one.pcd --bands 101
refused '.from: .*0,1' one.pcd --from 0,1
refused '.from: .*x,0,1' one.pcd --from x,0,1
refused '.from: .*no length' one.pcd --from 0,0,0
pcd '1 2 nan' '2 3 nan' >flat.pcd
refused 'flat.pcd: no point has a finite x, y and z' flat.pcd --from 0,-1,0

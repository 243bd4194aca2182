# Pictures of the cell and of the clearances along the path: whole PNG files, the same ones every time; a pose that is not there is
# refused. Reference: the size of the sheet, written in the first bytes of a PNG.
robot=$SAMPLES/robots/irb1400.json
path=$SAMPLES/paths/keel.pcd
fettle-part "$SAMPLES/parts/keel.json" >keel.stl
draw() { fettle-collide "$robot" "$path" --workpiece keel.stl --resolution 5 -q -o /dev/null "$@"; }
size() { od -An -j16 -N8 -t u1 "$1" | awk '{ print 256 * $3 + $4, 256 * $7 + $8 }'; }
draw --picture a.png --chart chart.png
draw --picture b.png --at 5,40 --from 0,-1,0.3
test "$(size a.png)" = "1284 622"
test "$(size b.png)" = "1284 1186"
test "$(size chart.png)" = "1100 460"
draw --picture c.png --at 5,40 --from 0,-1,0.3 --threads 1
cmp b.png c.png
draw --avoid --chart led.png
test "$(size led.png)" = "1100 740"
refuses() { "$HERE/../refuses" "$@" </dev/null; }
refuses 'pose 61: the path has only 61' fettle-collide "$robot" "$path" --resolution 5 --picture x.png --at 61
refuses "--at: expected whole numbers with commas between, got '1,x'" fettle-collide "$robot" "$path" --resolution 5 --picture x.png --at 1,x
refuses "--from" fettle-collide "$robot" "$path" --resolution 5 --picture x.png --from 0,0,0
test ! -e x.png

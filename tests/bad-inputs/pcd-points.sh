# Points that are hard to work with and files that are written unusually, in every place where a tool reads points: read, or refused in
# one line, within the bounds of probe.bash.
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
grid() { # SCRIPT: of awk, with i and j from 0 to 10; prints x y z
    awk "BEGIN { for (i = 0; i < 11; i++) for (j = 0; j < 11; j++) { $1 } }" | rows | pcd "$kFields"
}
echo '15 15 5' | rows | pcd "$kFields" >one.pcd
printf '10 10 5\n20 20 5\n' | rows | pcd "$kFields" >two.pcd
grid 'print 15, 15, 5' >equal.pcd
grid 'print i, i, i' >line.pcd
grid 'print 1e7 + 3 * i, 1e7 + 3 * j, 5 + 1e-4 * (i % 2)' >far.pcd
grid 'print 3 * i * 1e-42, 3 * j * 1e-42, 1e-42' >denormal.pcd
grid 'print "nan nan nan"' | sed 's/^WIDTH 121/WIDTH 11/; s/^HEIGHT 1/HEIGHT 11/' >organised-nan.pcd
grid 'if (i % 3) print 3 * i, 3 * j, 5; else print 3 * i, 3 * j, "nan"' >holes.pcd
grid 'print (i ? 3 * i : "-inf"), 3 * j, 5' >infinite.pcd
grid 'print 3 * i, 3 * j, (i ? 5 : "1e400")' >beyond.pcd
sed 's/$/\r/' good.pcd >crlf.pcd
tr '\n' '\r' <good.pcd >cr.pcd
head -c -1 good.pcd >no-final-newline.pcd
{ printf '\357\273\277'; cat good.pcd; } >bom.pcd
sed '/^FIELDS/ { s/ joint5 / _ /; s/ joint6 / _ / }' good.pcd >padding.pcd
{ sed -n '1,/^POINTS/p' good.pcd | sed 's/^WIDTH/HEIGHT/; t; s/^HEIGHT/WIDTH/' | sed '/^POINTS/d; s/^VERSION/POINTS 121\nVERSION/'; sed -n '/^DATA/,$p' good.pcd; } >points-first.pcd
sed 's/^VIEWPOINT.*/VIEWPOINT 0 0 0 0 0 0 0/' good.pcd >no-orientation.pcd
sed '/^TYPE/s/F F F/I I I/' good.pcd | awk '/^DATA/ { body = 1; print; next } body { $3 = int($3) } { print }' >integers.pcd
sed '/^SIZE/s/4 4 4/8 8 8/' good.pcd >doubles.pcd
{ sed 's/ascii/binary/' good.pcd | sed -n '1,/^DATA/p'; head -c $((121 * 4 * $(wc -w <<<"$kFields") + 5)) /dev/zero; } >trailing.pcd
for file in *.pcd; do
    case $file in good.pcd | samples.pcd) ;; *) points S "$file" ;; esac
done
all_tried 600

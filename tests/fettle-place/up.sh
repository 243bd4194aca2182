# A plate with a ramp, turned anywhere, lies again with its large face up; picked points and their plane likewise. Reference: the plate as it was made.
python3 - > plate.off <<'PYTHON'
corners = [(-30, -20, 0), (30, -20, 0), (30, 20, 0), (-30, 20, 0), (-30, -20, 8), (20, -20, 8), (20, 20, 8), (-30, 20, 8)]
faces = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
print("OFF\n8 6 0")
for c in corners: print(*c)
for f in faces: print(4, *f)
PYTHON
fettle-place plate.off --turn x,90,y,25,z,70 -o away.stl --transform-out away.txt
# The largest face is the one below, z = 0, which faces down: 2400 of 6112 mm2.
fettle-place away.stl --up plane --centre --report report.json -o below.stl --threshold 0.1
jq -e '.share > 0.385 and .share < 0.4' report.json > ok
fettle-align below.stl --to below.stl --near --iterations 0 --ascii | sed '1,/^DATA/d' > below
awk '{ z = $3; d = z > -1 ? z : z + 8; if (d > 1e-4 || d < -1e-4) bad = 1; n += z > -1 } END { exit bad || n != 4 }' below
# The other face by three corners that are picked on it, as CloudCompare and pcd_viewer list them.
awk 'NR >= 3 && NR <= 10' plate.off | sed -n '5p;6p;7p' > corners
awk 'NR == FNR { for (k = 1; k <= 4; k++) m[NR, k] = $k; next }
    { for (k = 1; k <= 3; k++) printf "%.9g%s", m[k, 1] * $1 + m[k, 2] * $2 + m[k, 3] * $3 + m[k, 4], k < 3 ? "," : "\n" }' away.txt corners > picked.txt
fettle-place away.stl --up picked.txt --report report.json -o above.stl
fettle-align above.stl --to above.stl --near --iterations 0 --ascii | sed '1,/^DATA/d' > above
awk 'NR == 1 || $3 > top { top = $3 } { z[NR] = $3 } END { for (i in z) { d = top - z[i]; if (d > 4) d -= 8; if (d > 1e-4 || d < -1e-4) bad = 1; n += top - z[i] < 4 } exit bad || n != 4 }' above
for threads in 1 2 7; do fettle-place away.stl --up plane --threads $threads -o $threads.stl; done
cmp 1.stl 2.stl
cmp 1.stl 7.stl

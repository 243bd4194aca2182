# A scanned hammer with a weld bead, put anywhere, comes back to the scan; the matrix that is reported is the one applied.
# Reference: the motion that it was given, undone; and the matrix applied by another program, bit for bit.
cat >away.txt <<'T'
-0.36 0.48 -0.8 300
0.8 0.6 0 -50
0.48 -0.64 -0.6 7.5
0 0 0 1
T
fettle-part "$SAMPLES/parts/hammer.json" >part.stl
fettle-align part.stl --to part.stl --transform-in away.txt --iterations 0 -o away.pcd
fettle-align away.pcd --to "$SAMPLES/scans/hammer.stl" --max-distance 0.5 --transform-out back.txt --report r.json --ascii >back.pcd
jq -e '.converged and .determined == 6 and .median < 1e-4 and .overlap > 0.8 and (.next.nearly_as_good | not)' r.json >/dev/null
fettle-align part.stl --to part.stl --near --iterations 0 --ascii >part.pcd
fettle-diff --tol 2e-4 back.pcd part.pcd # floats of 300 mm round by 3e-5

# what is in the report is in the file, and is what was applied
jq '.transform[][]' r.json | awk '{ printf "%.17g\n", $1 }' >reported.txt
tr ' ' '\n' <back.txt | diff reported.txt -
fettle-align away.pcd --to "$SAMPLES/scans/hammer.stl" --transform-in back.txt --iterations 0 --transform-out again.txt --ascii >again.pcd
cmp back.txt again.txt
cmp back.pcd again.pcd
# eighths are the same in text, float and double
awk 'BEGIN { for (i = 0; i < 1000; i++) print i / 8, (i * 37 % 1000) / 8, (i * 91 % 1000) / 8 }' >eighths.xyz
fettle-align eighths.xyz --to part.stl --transform-in back.txt --iterations 0 --ascii | sed '1,/^DATA/d' >applied
awk 'NR == FNR { for (k = 1; k <= 4; k++) m[NR, k] = $k; next }
    { for (k = 1; k <= 3; k++) printf "%.17g%s", ((m[k, 1] * $1 + m[k, 2] * $2) + m[k, 3] * $3) + m[k, 4], k < 3 ? " " : "\n" }' back.txt eighths.xyz >by-awk.xyz
fettle-align by-awk.xyz --to part.stl --near --iterations 0 --ascii | sed '1,/^DATA/d' | cmp - applied

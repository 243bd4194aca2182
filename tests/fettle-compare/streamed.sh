# A binary PCD that is streamed gives the same results as the same points in memory, from a file, a pipe and with little
# memory. Reference: the text of the points; and the mean offset.
awk 'BEGIN { for (i = 0; i < 400; i++) for (j = 0; j < 300; j++) print i, j, 0.25 + sin(i * j) / 10 }' >test.xyz
printf 'v -9 -9 0\nv 999 -9 0\nv 999 999 0\nv -9 999 0\nf 1 2 3 4\n' >plate.obj
fettle-compare test.xyz --to plate.obj -o test.pcd
fettle-compare test.pcd --to plate.obj --ascii -o text.pcd
fettle-compare text.pcd --to plate.obj --report held.json -o held.pcd
fettle-compare test.pcd --to plate.obj --report streamed.json -o streamed.pcd
cat test.pcd | fettle-compare --to plate.obj --report piped.json --max-memory 256 | cat >piped.pcd
for file in streamed piped; do
    cmp held.pcd $file.pcd
    cmp held.json $file.json
done
jq -e '.count == 120000 and (.mean - 0.25 | fabs) < 1e-3 and (.under_cut_volume - 120000 * .mean | fabs) < 1e-3' streamed.json
# The histogram holds every error once.
jq -e '.histogram.below + .histogram.above + (.histogram.counts | add) == 120000' streamed.json
fettle-compare held.pcd --to plate.obj --bins 4 --tolerance 0.25 --histogram bins.csv -o /dev/null || [ $? -eq 1 ]
awk -F , 'NR > 1 { n += $3 } END { exit !(n == 120000 && NR == 7) }' bins.csv

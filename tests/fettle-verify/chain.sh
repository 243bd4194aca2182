# fettle-mill and fettle-verify: a ball runs level over a block in passes 0.5 mm apart; the design is the plane that its tip
# runs in. No over-cut; what is left is at most the scallop, r - √(r² - 0.25²), and its mean the mean over a pass. With a
# re-sampled grid (--step) the same; and the same bytes with one thread and two.
# Reference: the scallop of a ball.
awk 'BEGIN { print "G0 X-5 Y0 Z9\nG1 Z5 F600"; for (y = 0; y <= 20; y += 0.5) { s = -s + (s == 0); printf "Y%g\nX%g\n", y, (s > 0 ? 25 : -5) } }' > passes.nc
printf 'OFF\n4 1 0\n-9 -9 5\n29 -9 5\n29 29 5\n-9 29 5\n4 0 1 2 3\n' > design.off
fettle-mill passes.nc --stock box:1,1,0,19,19,6 --cutter ball:6 --step 0.05 > part.stl
for n in 1 2; do fettle-verify part.stl --design design.off --tolerance 0.011 --threads $n --report $n.json > $n.pcd; done
cmp 1.pcd 2.pcd
cmp 1.json 2.json
jq -e '(3 - (9 - 0.0625 | sqrt)) as $scallop | .undefined == 0 and .min > -1e-6 and .max < $scallop + 1e-6 and
       .max > 0.8 * $scallop and (.mean / ($scallop / 3) - 1 | fabs) < 0.02 and .classes.serious_under_cut.count == 0' 1.json > ok
fettle-verify part.stl --step 0.1 --design design.off --tolerance 0.011 --report step.json > step.pcd
jq -e --slurpfile fine 1.json '(.mean / $fine[0].mean - 1 | fabs) < 0.02 and (.count / $fine[0].count * 4 - 1 | fabs) < 0.05' step.json > ok

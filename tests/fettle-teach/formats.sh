# One square picked in every way that is read makes the same job, to the byte: CloudCompare's picking list, a cloud it saved as text
# with blanks and a header or with semicolons, corners in plan with the height of the part, and the list of a page with both
# boundaries. Reference: the job from plain "x,y,z" lines; the plate's top at 0.75 in.
printf '0.5,0.5,0.75\n2.5,0.5,0.75\n2.5,2.5,0.75\n0.5,2.5,0.75\n' >plain.txt
printf '0.1,0.1,0.75\n2.9,0.1,0.75\n2.9,2.9,0.75\n0.1,2.9,0.75\n' >around.txt
teach() { fettle-teach "$SAMPLES/jobs/wang1.json" --sampling around.txt "$@"; }
teach --anomaly plain.txt >plain.json
for list in cloudcompare-list.txt cloudcompare-cloud.asc semicolons.txt; do teach --anomaly "$SAMPLES/picks/$list" | cmp - plain.json; done
fettle-teach "$SAMPLES/jobs/wang1.json" --anomaly "$SAMPLES/picks/page.txt" | cmp - plain.json
printf 'OFF\n4 2 0\n0 0 0.75\n3 0 0.75\n3 3 0.75\n0 3 0.75\n3 0 1 2\n3 0 2 3\n' >plate.off
teach --anomaly "$SAMPLES/picks/plan.txt" --on plate.off | cmp - plain.json
# columns in another order, as a header says
printf '//Z Y X\n0.75 0.5 0.5\n0.75 0.5 2.5\n0.75 2.5 2.5\n0.75 2.5 0.5\n' >turned.txt
! teach --anomaly turned.txt | cmp -s - <(teach --anomaly <(sed 1d turned.txt)) || exit 1
teach --anomaly turned.txt | cmp - plain.json

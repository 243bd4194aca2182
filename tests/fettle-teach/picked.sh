# Points as CloudCompare saves them, with and without index and label, and as pcd_viewer says them, make the same job; it holds the
# points and what was given, and is read by the next tool. Units: points in mm for a job in inches. References: the numbers.
printf '0.5,0.5,0.75\n2.5,0.5,0.75\n\n2.5,2.5,0.75\n0.5,2.5,0.76\n' > plain.txt
awk -F, 'NF { print "Point #" n++ "," 17 + n "," $0 }' plain.txt > labelled.txt
awk -F, 'NF { print n++ "," $0 }' plain.txt > indexed.txt
{ echo '> Loading scan.pcd [done, 12 ms]'; awk -F, 'NF { printf "Point index picked: %d (real: %d) - [%f, %f, %f]\n", NR, NR, $1, $2, $3 }' plain.txt; } > viewer.txt
awk -F, 'NF { printf "%.10g,%.10g,%.10g\n", $1 * 25.4, $2 * 25.4, $3 * 25.4 }' plain.txt > mm.txt
printf '0.1,0.1,0.75\n2.9,0.1,0.75\n2.9,2.9,0.75\n0.1,2.9,0.75\n' > around.txt
teach() { fettle-teach "$SAMPLES/jobs/wang1.json" --sampling around.txt --theta 30 --surface swept --direction 45 "$@"; }
teach --anomaly plain.txt --report report.json > plain.json
# A square of 2 in in one of 2.8 in; one point is 0.01 in higher than the others.
cat > expected.json << 'END'
{"kind": "teach", "units": {"length": "in"}, "anomaly_points": 4, "sampling_points": 4, "anomaly_area": 4, "sampling_area": 7.84, "lowest": 0.75, "highest": 0.76}
END
fettle-diff --tol 1e-12 report.json expected.json
for form in labelled indexed viewer; do teach --anomaly $form.txt | cmp - plain.json; done
fettle-teach "$SAMPLES/jobs/wang1.json" --theta 30 --anomaly mm.txt --file-units mm --report mm-report.json > mm.json
jq -e '.sampling_points == 0 and .sampling_area == 0 and (.anomaly_area - 4 | fabs) < 1e-8' mm-report.json > ok # wang1's surface is a plane
jq -e '.anomaly == [[0.5, 0.5, 0.75], [2.5, 0.5, 0.75], [2.5, 2.5, 0.75], [0.5, 2.5, 0.76]] and .frame.theta_deg == 30 and
    .surface == {"type": "swept", "direction_deg": 45} and (.sampling | length) == 4' plain.json > ok
jq -e --slurpfile a plain.json '[.anomaly, $a[0].anomaly] | map(flatten) | transpose | all((.[0] - .[1]) | fabs < 1e-9)' mm.json > ok
jq -e 'has("sampling") | not' mm.json > ok
jq -e --slurpfile a "$SAMPLES/jobs/wang1.json" '[.wheel, .force, .feed, .tolerance] == ($a[0] | [.wheel, .force, .feed, .tolerance])' plain.json > ok
fettle-part "$SAMPLES/parts/wang1.json" > part.stl
fettle-sample plain.json --on part.stl > samples.pcd

# The exit status: 0 within, 1 out of tolerance, 0 without one. An error equal to the tolerance is within, to the
# resolution of float coordinates.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n' >plate.obj
printf '1 1 0.02\n5 5 -0.01\n' >test.xyz
fettle-compare test.xyz --to plate.obj -o /dev/null
fettle-compare test.xyz --to plate.obj --tolerance 0.02 -o /dev/null --report report.json
jq -e '.verdict == "within" and .within == 1 and .judged == "all"' report.json >/dev/null
status=0
fettle-compare test.xyz --to plate.obj --tolerance 0.015 -o errors.pcd --report report.json || status=$?
[ $status -eq 1 ]
[ -s errors.pcd ]
jq -e '.verdict == "out of tolerance" and .within == 0.5 and (.worst - 0.02 | fabs) < 1e-8' report.json >/dev/null

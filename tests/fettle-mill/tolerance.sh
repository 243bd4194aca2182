# The grid from a tolerance. On a plane with a ball of 6 mm: R_x = √(3 e r) (Guan & Xiong, eq. 3); with a design, half a
# cylinder's crest of radius 20 with slopes to 45 degrees, e_s and e_p make up the tolerance, and the published rule is
# wider. Reference: the equations.
printf '5 10 6\n35 10 6\n' > path.xyz
awk 'BEGIN { OFMT = "%.15g"; print "OFF"; n = 180; print 2 * (n + 1), 2 * n, 0
    for (k = 0; k <= n; k++) { a = (k / n - 0.5) * 3.14159265358979 / 2; for (s = 0; s <= 1; s++) print 20 * sin(a), 40 * s, 20 * cos(a) }
    for (k = 0; k < n; k++) { print 3, 2 * k, 2 * k + 2, 2 * k + 1; print 3, 2 * k + 1, 2 * k + 2, 2 * k + 3 } }' > crest.off
mill() { fettle-mill path.xyz --stock box:0,0,0,40,20,8 --cutter ball:6 --tolerance 0.02 "$@" > part.stl; }
mill --report plane.json
jq -e '(.step - (0.18 | sqrt) | fabs) < 1e-12 and .discretization.convex_radius == null and
       (.discretization.predicted_error - 0.02 | fabs) < 1e-12' plane.json > ok
mill --design crest.off --report crest.json
mill --design crest.off --as-published --report published.json
jq -e '.discretization | .shape == "convex" and (.convex_radius / 20 - 1 | fabs) < 0.01 and .concave_radius == null and
       (.slope_deg - 44.5 | fabs) < 0.6 and (.predicted_error - 0.02 | fabs) < 1e-12 and
       (.surface_error + .sampling_error - 0.02 | fabs) < 1e-12' crest.json > ok
jq -e --slurpfile crest crest.json '(.step / ((0.02 / (1 / 80 + 1 / 9)) | sqrt) - 1 | fabs) < 1e-3 and .step > 1.2 * $crest[0].step' published.json > ok

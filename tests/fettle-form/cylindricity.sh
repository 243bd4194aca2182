# A quarter of a cylinder of radius 20 about the y axis, with ripples of ±0.05 in both directions, inside a job in
# inches. Reference: the minimum zone is no wider than the ripple, that of
# least squares slightly wider (its element is off the middle), and the axis is y.
cat >job.json <<'JSON'
{ "kind": "job", "units": {"length": "in", "force": "lbf"}, "surface": {"type": "swept", "direction_deg": 90},
  "anomaly": [[-30, -30], [30, -30], [30, 30], [-30, 30]], "sampling": [[-40, -40], [40, -40], [40, 40], [-40, 40]] }
JSON
awk 'BEGIN { for (i = -30; i <= 30; i++) for (j = -20; j <= 20; j++) { r = 20 + 0.05 * cos(i * 0.7) * cos(j * 0.5)
        print r * sin(i / 40), j, r * cos(i / 40) }
    print 99, 99, 99 }' >points.xyz # outside the boundary
fettle-form cylindricity points.xyz --within job.json >form.json
jq -e '.count == 61 * 41 and .units.length == "in" and .minimum_zone <= 0.1 and .least_squares >= .minimum_zone and
    .least_squares < 0.101 and .minimum_zone > 0.09 and (.elements.minimum_zone.axis[1]) > 0.999999 and
    (.elements.minimum_zone.radius - 20 | fabs) < 0.02' form.json >/dev/null

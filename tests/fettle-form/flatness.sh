# Five points. Reference: published values, least squares 0.0720973, minimum zone 0.0672621, held by four points.
printf '11.5 7 1.1\n18.5 6.9 1.03\n4.5 13 1.02\n25.5 30 1.03\n11.5 37.5 1.02\n' | fettle-form flatness --report report.json |
    jq -e '(.least_squares - 0.0720973 | fabs) < 5e-8 and (.minimum_zone - 0.0672621 | fabs) < 5e-8 and
        (.elements.minimum_zone.contacts | length) == 4 and .elements.minimum_zone.converged' >/dev/null
jq -e '.form == "flatness" and .count == 5' report.json >/dev/null
echo '{"least_squares": 0.0720973, "minimum_zone": 0.0672621}' > published.json
jq '{least_squares, minimum_zone}' report.json | fettle-diff - published.json --tol 5e-8

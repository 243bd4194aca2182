# A surface that is straight along its sections but for a ridge of 0.3 in one of them, at 30 degrees to X, in inches.
# Reference: exact; the ridge's section has the ridge's height, the others none, and across the sections it is a parabola.
awk 'BEGIN { c = cos(atan2(1, sqrt(3))); s = 0.5
    for (j = -3; j <= 3; j++) for (i = -20; i <= 20; i++) { a = i / 2; b = 2 * j
        printf "%.9g %.9g %.9g\n", c * a - s * b, s * a + c * b, b * b / 10 + a / 4 + (j == 1 && i == 4 ? 0.3 * sqrt(17) / 4 : 0) } }' >rows.xyz
fettle-form straightness rows.xyz --file-units in --sections 2 --section-width 0.01 --direction 30 >form.json
jq -e '.units.length == "in" and .parameter == "STRt" and (.sections | length) == 7 and (.minimum_zone - 0.3 | fabs) < 1e-6 and
    .offset == 2 and ([.sections[] | select(.minimum_zone < 1e-6)] | length) == 6 and .elements.least_squares.name == "LSLI" and
    (.elements.minimum_zone.contacts | length) == 3 and (.sections[0].offset + 6 | fabs) < 1e-9 and .count == 41' form.json >/dev/null
# One line: the width is the smallest height of a triangle, in any position; least squares is wider.
printf '0 0 0\n3 0 4\n6 0 8\n9 0 12\n4 0 3\n' | fettle-form straightness |
    jq -e '(.minimum_zone - 1.4 | fabs) < 1e-9 and .least_squares > .minimum_zone and ([.elements.minimum_zone.sides[]] | add | fabs) == 1' >/dev/null
# Outliers: without them the form is that of the rest, and they are counted.
awk 'BEGIN { for (i = 0; i < 400; i++) print i % 20, int(i / 20), (i % 7) / 1000 + (i == 111 ? 2 : 0) }' >sheet.xyz
fettle-form flatness sheet.xyz | jq -e '.minimum_zone > 1 and .outliers == 0' >/dev/null
fettle-form flatness sheet.xyz --outliers 6 | jq -e '.minimum_zone < 0.0061 and .outliers == 1 and .count == 399' >/dev/null

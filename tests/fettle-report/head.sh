# The head's fields, and the table nominal, actual, deviation of a form element. Reference: a sphere of radius 10.02 about (1, 2, 3.01)
# beside its nominal one of radius 10 about (1, 2, 3); the places of the cylinder and of the plane.
sphere() { awk -v r="$1" -v z="$2" 'BEGIN { for (i = 1; i < 9; i++) for (j = 0; j < 12; j++) { t = 3.14159265358979 * i / 9; p = 6.28318530717959 * j / 12
    printf "%.9f %.9f %.9f\n", 1 + r * sin(t) * cos(p), 2 + r * sin(t) * sin(p), z + r * cos(t) } }'; }
sphere 10.02 3.01 | fettle-form sphericity -o actual.json
sphere 10 3 | fettle-form sphericity -o nominal.json
fettle-report --form actual.json --nominal nominal.json --field-in-head 'part=Hammer <7>' --field-in-head 'serial number=0042' \
    --field-in-head operator=Maier --field-in-head date=2026-11-25 -o page.html --report page.json
grep -q '<dt>part</dt><dd>Hammer &lt;7&gt;</dd>' page.html
grep -q '<dt>serial number</dt><dd>0042</dd>' page.html
jq -e '.head == [["part", "Hammer <7>"], ["serial number", "0042"], ["operator", "Maier"], ["date", "2026-11-25"]]' page.json >/dev/null
figure() { tr '<' '\n' <page.html | sed -n "s/.*data-key=\"form.elements.$1\" data-value=\"\([^\"]*\)\".*/\1/p"; }
near() { awk -v a="$1" -v b="$2" 'BEGIN { exit !((a - b) ^ 2 < 1e-10) }'; }
near "$(figure diameter.nominal)" 20
near "$(figure diameter.actual)" 20.04
near "$(figure diameter.deviation)" 0.04
near "$(figure centre.z.deviation)" 0.01
near "$(figure centre.x.deviation)" 0
# The axis of a cylinder 0.03 beside the nominal one and at 1:1000 to it; a plane that lies 0.02 above the nominal one in its middle.
cylinder() { awk -v x="$1" -v slope="$2" 'BEGIN { for (z = -8; z <= 8; z += 2) for (j = 0; j < 12; j++) { p = 6.28318530717959 * j / 12
    printf "%.12f %.12f %.12f\n", x + 10 * cos(p) + slope * z, 10 * sin(p), z - slope * 10 * cos(p) } }'; }
plane() { awk -v z="$1" -v slope="$2" 'BEGIN { for (x = -4; x < 5; x++) for (y = 0; y < 9; y++) printf "%.9f %.9f %.9f\n", x, y, z + slope * x }'; }
cylinder 0.03 0.001 | fettle-form cylindricity -o actual.json
cylinder 0 0 | fettle-form cylindricity -o nominal.json
fettle-report --form actual.json --nominal nominal.json -o page.html
near "$(figure distance.actual)" 0.03
near "$(figure distance.deviation)" 0.03
near "$(figure angle.actual)" 0.0572957604
plane 0.02 0.001 | fettle-form flatness -o actual.json
plane 0 0 | fettle-form flatness -o nominal.json
fettle-report --form actual.json --nominal nominal.json -o page.html
near "$(figure distance.actual)" 0.02
near "$(figure angle.actual)" 0.0572957604
"$HERE/../refuses" "--field-in-head: expected NAME=VALUE, got 'Hammer'" fettle-report --form actual.json --field-in-head Hammer
"$HERE/../refuses" "--field-in-head: 'part' is given twice" fettle-report --form actual.json --field-in-head part=1 --field-in-head part=2
sed 's/flatness/straightness/' nominal.json >other.json
"$HERE/../refuses" 'other.json: is of the form straightness, which --form does not measure' fettle-report --form actual.json --nominal other.json

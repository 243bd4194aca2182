# The page is well-formed, holds all it shows, has the sections whose files are named and no others, and is the same for the
# same input. Reference: the XML parser of libxml2; byte comparison.
. "$HERE/run.bash"
page --title 'Part 1' -o page.html
page --title 'Part 1' --threads 1 | cmp - page.html
xmllint --noout --nonet page.html
# its scripts are in it
sed '/<!\[CDATA\[/,/\]\]>/d' page.html >markup.html
! grep -qiE '<(link|iframe|object|embed)|https?:|@import|url\(|src=' markup.html || exit 1
! grep -qE 'https?:|fetch\(|XMLHttpRequest|importScripts|<script [^>]*src' page.html || exit 1
test "$(grep -o 'href="[^"]\{22\}' page.html | sort -u)" = 'href="data:image/png;base64,'
for id in verdict job fit margin plan grinding registration maps statistics form provenance; do grep -q "<section id=\"$id\">" page.html; done
grep -q 'data-verdict="Within tolerance"' page.html
for file in part.stl samples.pcd errors.json; do grep -q "$(sha256sum $file | cut -d' ' -f1)" page.html; done

fettle-report --comparison errors.json -o numbers.html
xmllint --noout --nonet numbers.html
test "$(grep -o '<section id="[a-z]*"' numbers.html | tr '\n' ' ')" = '<section id="verdict" <section id="statistics" <section id="provenance" '
# in the units of the report, whichever other files are named
grep -q 'mean absolute error' numbers.html
grep -qE 'data-key="comparison.regions.inside.mean_abs"[^<]*</span> in<' numbers.html
# out of tolerance, and without any
fettle-compare ground.pcd --to truth.stl --within "$job" --tolerance 0.0001 --report tight.json -o /dev/null || test $? -eq 1
fettle-report --job "$job" --comparison tight.json | grep -q 'data-verdict="Out of tolerance"'
fettle-compare ground.pcd --to truth.stl --to-units in --report free.json -o /dev/null
fettle-report --comparison free.json | grep -q 'data-verdict="Not judged"'
# nothing to judge, a machine that stopped, a swept surface
jq '.worst = null' tight.json >nothing.json
fettle-report --comparison nothing.json | grep -q 'has an error to judge'
jq '.finished = false' grind.json >stopped.json
fettle-report --job "$job" --grinding stopped.json | grep -q 'Grinding not finished'
! fettle-report --job "$job" --grinding grind.json | grep -q 'Grinding not finished' || exit 1
jq '.surface = {"type": "swept", "direction_deg": 30}' "$job" >swept.json
fettle-report --job swept.json | grep -q 'swept, rulings 30°'
# outliers are named
jq '.fit.outliers = [2]' desired.json >outlier.json
fettle-report --job "$job" --surface outlier.json | grep -q 'Outliers, left out</th><td>1<.*>touch 2<'
# a low goodness of fit is explained, and that of a fit that left a touch out
explained() { jq ".fit.goodness = $1 | .fit.outliers = $2" desired.json >goodness.json && fettle-report --job "$job" --surface goodness.json; }
explained 0.0004 '[]' | grep -q 'one fit in 2.*500 has residuals as large'
explained 1e-9 '[]' | grep -q 'fewer than one fit in 10.*000 has residuals as large'
explained 1e-9 '[2]' | grep -q 'The outliers count in the goodness of fit'
! explained 0.02 '[]' | grep -qE 'one fit in|outliers count' || exit 1
# files of one run agree; those of another are reported
fettle-report --job "$job" --surface desired.json --plan plan.json -o /dev/null 2>err
test ! -s err
jq '.probe.accuracy *= 2' "$job" >other.json
jq '.shift += 0.001' desired.json >raised.json
fettle-report --job other.json --surface raised.json --plan plan.json -o /dev/null 2>err
grep -qx 'fettle-report: warning: plan.json: made for another job than other.json' err
grep -qx 'fettle-report: warning: plan.json: made for another surface than raised.json' err
# a plan carries job and surface
fettle-report --plan plan.json | grep -o '<section id="[a-z]*"' | tr '\n' ' ' >sections
grep -q 'id="job" <section id="fit" <section id="margin" <section id="plan"' sections
# a force far above F_max is told with its place; 1.1 times is the way of one reading
jq '.peak_force = 1000' grind.json >pressed.json
fettle-report --job "$job" --grinding pressed.json | grep -q 'data-verdict="Force above the limit".*, at x '
jq --argjson max "$(jq .force.max "$job")" '.peak_force = 1.1 * $max' grind.json >gentle.json
! fettle-report --job "$job" --grinding gentle.json | grep -q 'Force above the limit' || exit 1
# the part before and after, and the errors, can be turned
grep -q 'class="fettle-view"' page.html

# Every number of the page that an input holds is the input's: its key and full value are its attributes. Reference: the
# inputs themselves, read by jq; the passes' length from the report of fettle-plan; the trace's sums from that of fettle-grind.
. "$HERE/run.bash"
page -o page.html
grep -o 'data-key="[^"]*" data-value="[^"]*"' page.html | sed -E 's/data-key="([^"]*)" data-value="([^"]*)"/\1 \2/' | sort -u >shown
numbers() { # PREFIX FILE FILTER: every number with its path
    jq -r --arg prefix "$1" "$3"' | paths(numbers) as $p | "\($prefix).\($p | map(tostring) | join(".")) \(getpath($p))"' "$2"
}
{
    numbers job plan.json .job
    numbers surface desired.json .
    numbers plan plan.json '{layers, step}'
    numbers plan plan-report.json '{covering_length}'
    numbers grinding grind.json .
    numbers comparison errors.json .
    numbers alignment align.json .
    numbers form form.json .
} >known
# to 1e-12 where a length goes through mm; to 1e-6 where one goes through the pass frame
awk 'NR == FNR { known[$1] = $2; next }
    $1 ~ /^(trace|over_cut|judged|form\.elements)\./ { next } # computed: over-cut.sh, head.sh
    !($1 in known) { print "not in an input:", $1; bad = 1; next }
    { d = $2 - known[$1]; if (d < 0) d = -d; size = known[$1] < 0 ? -known[$1] : known[$1]
      tol = $1 ~ /^(grinding|comparison|alignment|form)/ ? 0 : $1 ~ /covering_length/ ? 1e-6 : 1e-12
      if (d > tol * size) { print $1, "shown", $2, "is", known[$1]; bad = 1 } }
    END { exit bad }' known shown
for part in job surface plan grinding comparison alignment form; do # not for want of numbers
    test "$(grep -c "^$part\." shown)" -ge 4
done
test "$(grep -c '^comparison\.regions\.inside\.' shown)" -eq 19
awk '/^trace\.layers\.[0-9]+\.time / { sum += $2 } /^trace\.layers\.[0-9]+\.peak_force / { if ($2 > peak) peak = $2 }
    END { printf "{\"machine_time\": %.9g, \"peak_force\": %.9g}\n", sum, peak }' shown >trace.json
jq '{machine_time, peak_force}' grind.json >grind-two.json
fettle-diff --tol 1e-5 trace.json grind-two.json

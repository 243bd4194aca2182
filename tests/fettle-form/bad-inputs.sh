# Everything refused: exit 2, one line that names the file or option and the value, nothing on stdout.
: >empty.xyz
printf '1 2 3\n' >one.xyz
printf '1 2 3\n2 4 6\n3 6 9\n-1 -2 -3\n0 0 0\n5 10 15\n' >line.xyz
awk 'BEGIN { for (i = 0; i < 20; i++) print i, i * i, 1 }' >plane.xyz
printf 'nan nan nan\nnan 1 2\n' >nan.xyz
refused() {
    local status=0
    fettle-form "$@" >out 2>err </dev/null || status=$?
    [ $status -eq 2 ] && [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ] || { echo "not refused: $*: $status" >&2; exit 1; }
}
for form in flatness cylindricity sphericity; do
    for file in empty one line; do refused $form $file.xyz; done
    refused $form nan.xyz -q
done
refused cylindricity plane.xyz
refused sphericity plane.xyz
grep -q 'plane.xyz: sphericity: .*no curvature' err
refused flatnes plane.xyz
grep -q "did you mean 'flatness'" err
refused
refused flatness plane.xyz --file-units ft
for file in empty one nan; do refused straightness $file.xyz -q; done
awk 'BEGIN { for (i = 0; i < 9; i++) print 1, 1, 1 }' >equal.xyz
refused straightness equal.xyz
refused straightness plane.xyz --sections 0
refused flatness plane.xyz --sections 1
refused straightness plane.xyz --section-width 1
refused straightness plane.xyz --sections 1 --section-width 1e15
grep -q -- '--section-width: must be at most 100 times --sections' err
refused straightness plane.xyz --sections 1e-9
refused straightness plane.xyz --sections 1 --section-width 0.1 --direction 90
grep -q 'plane.xyz: straightness: no section has as many as 3 points' err
refused straightness plane.xyz --sections 1 --direction 1e9
refused flatness plane.xyz --outliers 0
refused flatness plane.xyz --outliers nan
fettle-form straightness line.xyz | jq -e '.least_squares < 1e-12 and .minimum_zone < 1e-12' >/dev/null
fettle-form flatness plane.xyz | jq -e '.least_squares < 1e-12 and .minimum_zone < 1e-12' >/dev/null

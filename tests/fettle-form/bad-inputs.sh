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
fettle-form flatness plane.xyz | jq -e '.least_squares < 1e-12 and .minimum_zone < 1e-12' >/dev/null

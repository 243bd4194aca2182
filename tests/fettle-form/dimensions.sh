# Every number of the report scales as its dimension: the same points in mm, in and m.
mm_per() { case $1 in mm) echo 1 ;; in) echo 25.4 ;; m) echo 1000 ;; esac; }
powers='{"count": 0, "dropped": 0, "outliers": 0, "least_squares": 1, "minimum_zone": 1, "width": 1, "point": 1, "normal": 0, "axis": 0, "radius": 1,
    "centre": 1, "peak": 1, "valley": 1, "rms": 1, "contacts": 1, "sides": 0, "offset": 1, "sections_too_few": 0}'
for unit in mm in m; do
    mkdir $unit
    awk -v mm="$(mm_per $unit)" 'BEGIN { for (i = 0; i < 24; i++) for (j = 0; j < 9; j++) {
        a = 0.21 * i; r = 20 + 0.1 * sin(5 * i + 3 * j); b = 0.15 * j
        printf "%.17g %.17g %.17g\n", i / mm, j / mm, (i / 9 + 0.1 * sin(5 * i + 3 * j)) / mm >"'$unit'/flatness.xyz"
        printf "%.17g %.17g %.17g\n", r * cos(a) / mm, r * sin(a) / mm, 4 * j / mm >"'$unit'/cylindricity.xyz"
        printf "%.17g %.17g %.17g\n", r * cos(a) * cos(b) / mm, r * sin(a) * cos(b) / mm, r * sin(b) / mm >"'$unit'/sphericity.xyz" } }'
    for form in flatness cylindricity sphericity; do
        fettle-form $form $unit/$form.xyz --file-units $unit --units $unit --outliers 6 -q >$unit/$form.json
    done
    fettle-form straightness $unit/flatness.xyz --file-units $unit --units $unit -q >$unit/straightness.json \
        --sections "$(awk -v mm="$(mm_per $unit)" 'BEGIN { printf "%.17g", 2 / mm }')" --section-width "$(awk -v mm="$(mm_per $unit)" 'BEGIN { printf "%.17g", 1 / mm }')"
done
for unit in in m; do
    for form in flatness cylindricity sphericity straightness; do "$HERE/../scales" $unit "$powers" mm/$form.json $unit/$form.json; done
done

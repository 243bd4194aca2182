# Sourced by cases that do the same work in mm and N and in inches and pounds: every field of a PCD and every key of a report has
# a dimension, and its numbers scale with it. What is not in the table fails the case: a new field or key needs its line.
kInch=25.4 kPound=4.4482216152605
dimensions='x 1 0
y 1 0
z 1 0
removed 1 0
deflection 1 0
radius 1 0
feed 1 0
wheel_radius 1 0
removed_volume 3 0
force 0 1
peak_force 0 1
t 0 0
layer 0 0
pass 0 0
event 0 0
finished 0 0
machine_time 0 0
grinding_time 0 0
travel_time 0 0
service_time 0 0
contact_time 0 0
within 0 0
layers 0 0
coverings 0 0
strokes 0 0
re_cuts 0 0
raises 0 0
passes 0 0
steps 0 0
touch_offs 0 0
wheel_changes 0 0
dropped_facets 0 0'
same_fields() { # TOLERANCE MM.pcd INCH.pcd: relative to the largest number of the field; ascii
    awk -v table="$dimensions" -v inch=$kInch -v pound=$kPound -v tolerance="$1" '
        BEGIN { n = split(table, lines, "\n"); for (i = 1; i <= n; i++) { split(lines[i], w, " "); unit[w[1]] = inch ^ w[2] * pound ^ w[3] } }
        FNR == 1 { body = 0; row = 0; file++ }
        /^FIELDS/ { for (k = 2; k <= NF; k++) { if (!($k in unit)) { print $k ": no dimension"; bad = 1; exit } name[k - 1] = $k }; fields = NF - 1 }
        body { row++; rows[file] = row; for (k = 1; k <= fields; k++) {
            v = $k * (file == 2 ? unit[name[k]] : 1)
            if (file == 1) { first[row, k] = v; if (v * v > max[k]) max[k] = v * v; continue }
            if ((v - first[row, k]) ^ 2 > tolerance ^ 2 * max[k] + 1e-24) { print name[k] " of point " row ": " v " for " first[row, k]; bad = 1; exit } } }
        /^DATA/ { body = 1 }
        END { exit bad || rows[1] != rows[2] || !rows[1] }' "$2" "$3" || { echo "$2 and $3 differ"; return 1; }
}
same_keys() { # TOLERANCE MM.json INCH.json
    jq -n --arg table "$dimensions" --argjson inch $kInch --argjson pound $kPound --argjson tolerance "$1" \
        --slurpfile a "$2" --slurpfile b "$3" '
        ($table / "\n" | map((. / " ") as [$name, $length, $force] | {($name): (pow($inch; $length | tonumber) * pow($pound; $force | tonumber))}) | add) as $unit |
        $a[0] | to_entries[] | select(.key | IN("kind", "units", "loops") | not) | .key as $k | .value as $v |
        if $unit[$k] == null then "\($k): no dimension"
        elif ($v | type) != "number" then (if $v == $b[0][$k] then empty else "\($k): \($b[0][$k]) for \($v)" end)
        elif ($b[0][$k] * $unit[$k] - $v | fabs) <= $tolerance * ($v | fabs) then empty
        else "\($k): \($b[0][$k] * $unit[$k]) for \($v)" end' -r > differing
    cat differing
    [ ! -s differing ] && jq -e -n --slurpfile a "$2" --slurpfile b "$3" '($a[0] | keys) == ($b[0] | keys)' > ok
}
inch_job() { # of job.json, in in-job.json
    jq --argjson l $kInch --argjson f $kPound '.units = {length: "in", force: "lbf"} | .anomaly |= map(map(. / $l)) |
        .tolerance /= $l | .safe_height /= $l | .wheel |= map_values(. / $l) | .force.stiffness *= $l |
        .force |= map_values(. / $f) | .feed |= map_values(. / $l) | .removal.coefficient *= $f / ($l * $l * $l)' job.json > in-job.json
}

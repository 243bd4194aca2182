# One plan in mm, inches and metres, and in pounds: numbers and fields scale as their dimensions; limits that are not given are
# the same lengths a second, whatever the unit. Reference: the plan in mm; rounding decides at the rim of the contact,
# which moves the results by less than 2 %.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate | awk '/^DATA/ { print; data = 1; next } data { $7 = 0.2 + 0.1 * sin($1 / 4) } { print }' > plate.pcd
printf '# .PCD v0.7\nVERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 8 8 8 8 8 8 8\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\nWIDTH 6\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 6\nDATA ascii\n' > path.pcd
for x in -9.863 -5.863 -1.863 2.137 6.137 10.137; do echo "$x" 0.071 5 1 0 0 0 >> path.pcd; done
scaled() { # FILE MM UNITS: its lengths in another unit
    awk -v mm="$2" -v units="$3" 'NR == 1 { print; print "# units", units; next }
        /^SIZE/ { gsub("4", "8") }
        body { for (k = 1; k <= NF; k++) if (k < 4 || (k == 7 && NF == 7 && plate)) $k = sprintf("%.17g", $k / mm) }
        /^FIELDS/ { plate = /displacement/ } /^DATA/ { body = 1 } { print }' "$1"
}
plan() { # NAME OPTION…
    fettle-feed "path-$1.pcd" --on "plate-$1.pcd" --wheel "$SAMPLES/wheels/crowned_preston.json" --cells 12 --rounds 2 --ascii --report "$1.json" "${@:2}" > "$1.pcd"
    grep '^FIELDS' "$1.pcd" > "$1.fields"
}
report='{"points": 0, "touched": 0, "reached": 0, "rms_before": 1, "rms_constant": 1, "rms_planned": 1, "ratio": 0, "time_constant": 0,
    "time_planned": 0, "at_min": 0, "at_max": 0, "rounds": 0, "constant": 1}'
fields='{"x": 1, "y": 1, "z": 1, "qw": 0, "qx": 0, "qy": 0, "qz": 0, "force": 0, "feed": 1}'
while read -r unit mm; do
    scaled path.pcd "$mm" "$unit" > "path-$unit.pcd"
    scaled plate.pcd "$mm" "$unit" > "plate-$unit.pcd"
    plan "$unit" --force 5
    "$HERE/../scales" "$unit" "$report" mm.json "$unit.json" 0.02
    "$HERE/../scales" "$unit" "$fields" mm.pcd "$unit.pcd" 0.02
    [ "$(cat "$unit.fields")" = 'FIELDS x y z qw qx qy qz force feed' ]
    grep -q "^# units $unit" "$unit.pcd"
done <<'END'
mm 1
in 25.4
m 1000
END
# Forces of a path in pounds: its field and `constant` are in pounds.
scaled path.pcd 1 'mm lbf' > path-lbf.pcd
cp plate-mm.pcd plate-lbf.pcd
plan mm --force 5 --vary force --feed 5
plan lbf --force 5 --vary force --feed 5
"$HERE/../scales" lbf "$(jq 'map_values(0) + {constant: 1}' <<<"$report")" mm.json lbf.json 0.02
"$HERE/../scales" lbf "$(jq 'map_values(0) + {force: 1}' <<<"$fields")" mm.pcd lbf.pcd 0.02
"$HERE/../refuses" '--min: is above --max' fettle-feed path-m.pcd --on plate-m.pcd --wheel "$SAMPLES/wheels/crowned_preston.json" --force 5 --min 0.2
for option in --min --max --wanted; do
    "$HERE/../refuses" "$option" fettle-feed path-mm.pcd --on plate-mm.pcd --wheel "$SAMPLES/wheels/crowned_preston.json" --force 5 $option 1e300
done

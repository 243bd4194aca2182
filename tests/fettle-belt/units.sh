# Every field of the surfels and of the trace, and every key of the reports, scales as its dimension when the same run is in
# inches or metres.
# shellcheck source=tests/fettle-contact/plate.bash
. "$HERE/../fettle-contact/plate.bash"
plate | sed 's/displacement/displacement area/; s/^SIZE.*/& 4/; s/^TYPE.*/& F/; s/^COUNT.*/& 1/; /^-*[0-9].* 0.25$/s/$/ 0.25/' > mm.surfels
wheel 10 0.45 > wheel.json
awk 'BEGIN {
    printf "# units mm\nVERSION 0.7\nFIELDS x y z qw qx qy qz\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\nCOUNT 1 1 1 1 1 1 1\n"
    printf "WIDTH 5\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 5\nDATA ascii\n"
    for (i = 0; i < 5; ++i) printf "%g 0 5.25 1 0 0 0\n", i - 2 }' > mm.path
convert() { # UNIT PER: lengths of x y z, and in the last two columns of the surfels
    for file in surfels path; do
        awk -v per="$2" -v unit="$1" '$1 == "#" { next } $1 == "VERSION" { print "# units", unit }
            data { $1 *= per; $2 *= per; $3 *= per; if (NF == 8) { $7 *= per; $8 *= per ^ 2 } } $1 == "DATA" { data = 1 } { print }' \
            OFMT=%.9g CONVFMT=%.9g mm.$file > "$1.$file"
    done
}
powers='{"x": 1, "y": 1, "z": 1, "normal_x": 0, "normal_y": 0, "normal_z": 0, "displacement": 1, "area": 2, "removed": 1, "removed_volume": 3,
    "qw": 0, "qx": 0, "qy": 0, "qz": 0, "t": 0, "force": 0, "indentation": 1, "pressure": -2, "peak_pressure": -2, "points": 0,
    "time": 0, "work": 0, "touched": null, "surfels": 0, "deepest": 1, "max_force": 0, "max_area": 2, "near_edge": 0, "coarse_grids": 0, "cell": 1,
    "iterations": 0, "gap": 1}'
grind() { # UNIT FEED DEPTH...
    fettle-belt "$1.surfels" --wheel wheel.json --path "$1.path" --depth "$3" --feed "$2" --cells 16 --ascii --trace "$1.trace.pcd" --report "$1.json" \
        -o "$1.ground.pcd"
    fettle-contact "$1.surfels" --wheel wheel.json --at "$4" --depth "$3" --cells 16 --ascii --report "$1.contact.json" -o "$1.contact.pcd"
}
grind mm 5 0.2 0,0,5.25,1,0,0,0
convert in 0.0393700787
convert m 0.001
grind in 0.1968503937 0.00787401575 0,0,0.206692913,1,0,0,0
grind m 0.005 0.0002 0,0,0.00525,1,0,0,0
for file in ground.pcd trace.pcd json contact.pcd contact.json; do
    "$HERE/../scales" in "$powers" mm.$file in.$file
    "$HERE/../scales" m "$powers" mm.$file m.$file
done

# Against a reference: the hammer with its bead, moved and bent by 0.8 mm over its length, is registered to its bare scan, and the bead is found
# where it is; bent without the bead nothing is. Reference: the bead that fettle-part has made.
# shellcheck source=tests/fettle-find/part.bash
. "$HERE/part.bash"
bend() { # IN OUT: a shift of z by a half wave along x, and 30 mm along y
    fettle-clean "$1" --format csv > points.csv
    awk -F , 'NR == 1 { print "x y z"; next } { print $1, $2 + 30, $3 + 0.8 * sin($1 / 35) }' points.csv > "$2"
}
hammer -o worn.stl
fettle-compare worn.stl --to "$SAMPLES/scans/hammer.stl" --tolerance 99 -o worn.pcd
hammer --without-anomaly -o bare.stl
fettle-compare bare.stl --to "$SAMPLES/scans/hammer.stl" --tolerance 99 -o bare.pcd
bend worn.pcd worn.xyz
bend bare.pcd bare.xyz
fettle-find worn.xyz --against "$SAMPLES/scans/hammer.stl" --min-height 0.5 --transform-out T.txt --report found.json > found.pcd || [ $? = 1 ]
jq -e '(.anomalies | length) == 1 and (.anomalies[0] | .height > 2.2 and .height < 3.3 and .volume > 300 and .volume < 560)' found.json > ok
awk 'NR == 2 { exit !($4 < -28 && $4 > -32) }' T.txt
fettle-find worn.xyz --against "$SAMPLES/scans/hammer.stl" --min-height 0.5 --transform-in T.txt --report again.json > again.pcd || [ $? = 1 ]
jq -e --slurpfile a found.json '.anomalies[0].height - $a[0].anomalies[0].height | fabs < 0.01' again.json > ok
fettle-find bare.xyz --against "$SAMPLES/scans/hammer.stl" --min-height 0.5 --report bare.json > none.pcd
jq -e '.anomalies == []' bare.json > ok
# The same part as triangles, where it was made: bead and burr in one piece, with the volume between part and scan within a fifth, and a job; without them nothing. Views
# from beside see half of a bead as well, and do not part it.
printf '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' > identity.txt
mesh() { fettle-find "$1.stl" --against "$SAMPLES/scans/hammer.stl" --transform-in identity.txt --jobs "$1" --template "$SAMPLES/jobs/hammer.json" --report "$1.json" -o "$1.found.pcd"; }
mesh worn
mesh bare
fettle-compare worn.stl --to "$SAMPLES/scans/hammer.stl" --tolerance 0.2 --report added.json -o added.pcd || [ $? = 1 ]
jq -e --slurpfile added added.json '(.anomalies | length) == 1 and (.anomalies[0] | .job != "" and (.volume / $added[0].under_cut_volume - 1 | fabs) < 0.2)' worn.json > ok
jq -e '.anomalies == []' bare.json > ok

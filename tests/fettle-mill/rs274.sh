# An independent interpreter (rs274 of LinuxCNC) follows programs to the same places, by the same arcs: every motion word in both
# units, absolute and relative, in all planes, and a program of the samples. Reference: rs274, which
# prints four decimals, of inches half of 2.5e-3 mm.
command -v rs274 > /dev/null || { echo "rs274 (linuxcnc-uspace) is not installed"; exit 77; }
cat > words.nc <<'END'
%
(words)
N10 G21 G90 G17 G94 G40 G49 G80
N20 G0 X1 Y2 Z30 ; comment
N30 G1 Z3 F600
G2 X11 Y2 I5
G3 X1 Y2 R5.5
G3 X7 Y2 R-4
G2 I-3 Z5
g18 g2 x10 z4 i1.5 k-.5
G19 G3 Y4 Z4 J1 K0
G17 G91 G1 X-2.5 Y1
G2 X2 Y2 J2
G0 Z+10.
G20 X.1
G1 Y-0.25 F20
G90 G3 X0.5 Y-.5 R2
M5 M9
G64 P0.001 G0 Z2
M30
%
END
places() { # of the ends of motions, in the order of the program, mm: rs274 prints units of the program at that time
    printf 'T1 P1 D0 Z0\n' > tool.tbl
    rs274 -t tool.tbl -g "$1" 2> messages | awk -F'[(),]' '
        /USE_LENGTH_UNITS/ { unit = /INCHES/ ? 25.4 : 1 }
        /SELECT_PLANE/ { plane = $2 }
        /STRAIGHT_(TRAVERSE|FEED)\(/ { x = $2; y = $3; z = $4; print x * unit, y * unit, z * unit }
        /ARC_FEED\(/ {
            if (plane ~ /XY/) { x = $2; y = $3; z = $7 } else if (plane ~ /XZ/) { z = $2; x = $3; y = $7 } else { y = $2; z = $3; x = $7 }
            print x * unit, y * unit, z * unit }'
}
for program in words.nc "$SAMPLES/programs/pocket.nc"; do
    fettle-mill "$program" --stock box:-50,-50,-20,100,100,0 --cutter ball:6 --step 2 --trace trace.pcd --ascii -q --report report.json -o part.stl || test $? = 1
    # rs274 starts at 0, 0, 0 while some coordinate is not known yet
    places "$program" | tail -n +$((1 + $(jq .unplaced_rapids report.json))) > theirs
    # the last point of each line of the program
    awk '/^DATA/ { body = 1; next } body { if (n && $9 != line) print at; at = $1 " " $2 " " $3; line = $9; n++ } END { print at }' trace.pcd > ours
    awk 'NR == FNR { their[++n] = $0; next } { split(their[FNR], t); for (k = 1; k <= 3; k++) if ($k - t[k] > 1.4e-3 || t[k] - $k > 1.4e-3) { print FNR ": " $0 " against " their[FNR]; exit 1 } m++ }
        END { if (m != n || n < 15) { print m " places against " n; exit 1 } }' theirs ours
done

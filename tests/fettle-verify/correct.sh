# --correct takes errors back that lie in the path: a program that is 0.1 mm too low and 0.2 mm beside (a workpiece that was
# set up wrong), points made for a ball of 12 mm that one of 10 mm cuts along (a worn cutter), and points so far apart that
# their chords cut into a convex sphere. fettle-mill and fettle-verify confirm: of the errors' rms at most a fifth is left, and
# no over-cut beyond 5e-3 mm, which is what half a cell of the grid makes of a chord. What the program says beside its moves
# stays, and in G20 it stays in inches. Reference: the design; what the ridges between passes leave (rms 2e-3 mm) is no error of the path.
fettle-part --without-anomaly "$SAMPLES/parts/wang3.json" > design.stl
cutter=ball:12
finish() { fettle-finish design.stl --file-units in --cutter ball:12 --scallop 0.01 "$@"; }
confirmed() { # NAME PATH CUTTER
    local corrected=corrected.nc
    [ "${2##*.}" = nc ] || corrected=corrected.pcd
    for round in before after; do
        fettle-mill "$2" --stock box:10,10,-20,50,50,26 --cutter "$3" --step 0.3 > part.stl
        fettle-verify part.stl --design design.stl --design-units in --correct "$2" --cutter "$3" --corrected "$corrected" \
            --tolerance 0.15 --inner-tolerance 1 --report "$1-$round.json" > patches.pcd
        set -- "$1" "$corrected" "$3"
        cp "$2" "$1-$round.${2##*.}"
    done
    jq -e --slurpfile before "$1-before.json" '.rms <= 0.2 * $before[0].rms and .min > -5e-3 and .undefined == 0' "$1-after.json" > ok
}
finish | sed 's/^G21 /(sphere)\nM3 S9000\nG21 /' | awk '{ line = ""
    for (i = 1; i <= NF; i++) { w = $i; if (w ~ /^Z[-0-9]/) w = sprintf("Z%.5f", substr(w, 2) - 0.1); if (w ~ /^X[-0-9]/) w = sprintf("X%.5f", substr(w, 2) + 0.2)
        line = line (i > 1 ? " " : "") w } print line }' > low.nc
confirmed setup low.nc ball:12
head -n 4 setup-after.nc
finish --pcd > thick.pcd
confirmed worn thick.pcd ball:10
printf 'x y z\n' > chords.xyz
finish --pcd --ascii | awk '/^DATA/ { body = 1; next } body && $4 > 0 && ($2 != last || n++ % 20 == 0) { last = $2; print $1, $2, $3 }' >> chords.xyz
confirmed chords chords.xyz ball:12
# Inches: the same machining after the same correction, but for what thinning leaves out.
printf 'G20 (inches)\nG0 X0.5 Y0.8 Z2\nG1 Z0.6 F20\nX1.5\nM30\n' > inch.nc
printf 'G0 X12.7 Y20.32 Z50.8\nG1 Z15.24 F508\nX38.1\nM30\n' > mm.nc
for path in inch.nc mm.nc; do
    fettle-mill $path --stock box:12,18,-20,40,23,26 --cutter ball:6 --step 0.3 > part.stl || test $? = 1
    fettle-verify part.stl --design design.stl --design-units in --correct $path --cutter ball:6 --corrected c-$path --tolerance 30 -q > patches.pcd
    fettle-mill c-$path --stock box:12,18,-20,40,23,26 --cutter ball:6 --step 0.3 > $path.stl || test $? = 1
done
grep -c 'G20 (inches)' c-inch.nc
fettle-diff --tol 1e-4 inch.nc.stl mm.nc.stl

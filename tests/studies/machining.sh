# The machined mould: the make file from the design to the verdict, on a coarse grid. Reference: the design.
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-mill)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
study() { make --no-print-directory -C "$root" -f pipelines/machining.mk B="$build" MACHINING="$PWD/out" PASSES='--scallop 2' GRID=2 TOLERANCE=4 -s; }
study >table
grep -q '^over-cut beyond 4 mm: none' table
grep -q 'rapid moves through material: 0' table
for file in finish.nc machined.stl patches.pcd sheet.csv errors.png verdict.json; do test -s out/$file; done
# No vertex of the grid is lower than the design by more than the path's chords: 0.005 mm in their middle, and less than twice that
# anywhere.
fettle-verify out/machined.stl --design "$SAMPLES/designs/mould.stl" --design-units m -q --z-errors z.pcd --ascii >patches.pcd || test $? = 1
awk '/^DATA/ { body = 1; next } body { n++; if ($4 < -0.01) exit 1 } END { if (n < 10000) exit 1 }' z.pcd

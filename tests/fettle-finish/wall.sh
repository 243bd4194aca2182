# A block with walls on a plate: no cutter of any shape gouges either, and rapid moves keep above. Reference: the
# design, to the floats of an STL; patches on the walls are left out and counted, but
# not the vertices before and behind them: none is lower than the design by more than the chords' 0.005 mm.
cat > block.off <<'END'
OFF
16 13 0
0 0 0
30 0 0
30 30 0
0 30 0
10 10 0
20 10 0
20 20 0
10 20 0
10 10 6
20 10 6
20 20 6
10 20 6
0 0 -3
30 0 -3
30 30 -3
0 30 -3
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
4 4 5 9 8
4 5 6 10 9
4 6 7 11 10
4 7 4 8 11
4 8 9 10 11
4 12 15 14 13
4 0 12 13 1
4 1 13 14 2
4 2 14 15 3
END
for cutter in ball:4 flat:4 bull:4,1 taper:6,10,1; do
    fettle-finish block.off --cutter $cutter --step-over 0.5 > path.nc
    fettle-mill path.nc --stock box:0.3,0.3,-3,29.7,29.7,8 --cutter $cutter --step 0.2 --report mill.json > part.stl
    fettle-verify part.stl --design block.off --tolerance 0.01 -q --report verdict.json --z-errors z.pcd --ascii > patches.pcd
    jq -e '.min > -1e-5 and .undefined_by_patch.vertical > 400 and .undefined_by_patch.not_hit == 0 and .p50 < 0.03' verdict.json > ok
    awk '/^DATA/ { body = 1; next } body { n++; if ($4 < -0.0051) { print; exit 1 } } END { if (n == 0) exit 1 }' z.pcd
done

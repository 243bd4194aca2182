# The loop closes: design, path, machined part, verdict. Wang's sphere of 4 in with passes for ridges of 0.05 mm: no patch is
# over-cut by more than the chords of the path (a third of the step-over on a radius of 101.6 mm: 2e-4 mm) and the rounding
# of floats in inches, none is left higher than the ridges; and the program cuts what the points cut, but for its five
# decimals. Reference: the requested scallop height.
fettle-part --without-anomaly "$SAMPLES/parts/wang3.json" > design.stl
for cutter in ball:12 bull:12,3; do
    fettle-finish design.stl --file-units in --cutter $cutter --scallop 0.05 --report finish.json > finish.nc
    fettle-finish design.stl --file-units in --cutter $cutter --scallop 0.05 --pcd > finish.pcd
    for path in finish.nc finish.pcd; do
        fettle-mill $path --stock box:0.5,0.5,-20,75.7,75.7,26 --cutter $cutter --step 0.25 --report mill.json > $path.stl
        jq -e '.rapid_cuts.moves == 0' mill.json > ok
    done
    fettle-diff --tol 1e-4 finish.nc.stl finish.pcd.stl
    fettle-verify finish.nc.stl --design design.stl --design-units in --tolerance 0.05 --report verdict.json > patches.pcd
    jq -e '.min > -6e-4 and .max <= 0.05 and .max > 0.02 and .undefined == 0 and .within == 1' verdict.json > ok
done

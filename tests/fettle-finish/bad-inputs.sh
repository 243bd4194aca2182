# What is no design, no cutter or no spacing ends with status 2, one line that names it, and nothing on stdout.
printf 'OFF\n4 1 0\n0 0 5\n40 0 5\n40 30 5\n0 30 5\n4 0 1 2 3\n' > plane.off
printf 'OFF\n4 1 0\n0 0 5\n40 0 5\n40 30 5\n0 30 5\n4 3 2 1 0\n' > down.off
: > empty.stl
refused() { "$HERE/../refuses" "$@"; }
refused 'give either --scallop or --step-over' fettle-finish plane.off --cutter ball:6
refused 'give either --scallop or --step-over' fettle-finish plane.off --cutter ball:6 --scallop 0.1 --step-over 1
refused '--cutter' fettle-finish plane.off --scallop 0.1
refused '--cutter: expected ball:D' fettle-finish plane.off --cutter drill:6 --scallop 0.1
refused 'plane.off: a cutter without ball or corner' fettle-finish plane.off --cutter flat:6 --scallop 0.1
refused 'plane.off: a step-over of 1e-06 mm' fettle-finish plane.off --cutter flat:6 --step-over 1e-6
refused 'down.off: no facet of the design faces up' fettle-finish down.off --cutter ball:6 --scallop 0.1
refused 'empty.stl: empty' fettle-finish empty.stl --cutter ball:6 --scallop 0.1
refused '--ascii: points are written with --pcd' fettle-finish plane.off --cutter ball:6 --scallop 0.1 --ascii
refused 'x.pcd: is not written as pcd: points are written with --pcd' fettle-finish plane.off --cutter ball:6 --scallop 0.1 -o x.pcd
refused '--scallop' fettle-finish plane.off --cutter ball:6 --scallop 0
refused '--allowance' fettle-finish plane.off --cutter ball:6 --scallop 0.1 --allowance -1
for option in --scallop --step-over --overhang --feed --clearance --allowance --angle; do
    how=(--step-over 1)
    [ $option != --scallop ] && [ $option != --step-over ] || how=()
    refused "$option" fettle-finish plane.off --cutter ball:6 "${how[@]}" $option 1e300
done
refused '--cutter: the diameter must be in' fettle-finish plane.off --cutter ball:1e-300 --step-over 1

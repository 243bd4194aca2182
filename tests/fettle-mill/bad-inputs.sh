# What is no path, stock, cutter or command line ends with status 2, one line that names it and the place, and nothing on
# stdout.
printf '0 0 5\n9 9 5\n' > path.xyz
printf 'G0 X0 Y0 Z5\nG81 X5\n' > cycle.nc
printf 'G0 X0 Y0 Z5\nG1 X5\n' > feed.nc
printf '0 0 5\n9 nan 5\n' > nan.xyz
printf '0 0 5\n' > one.xyz
printf 'x y z feed\n0 0 5 1\n1 1 5 -1\n' > slow.xyz
printf 'x y z qw qx qy qz\n0 0 5 1 0 0 0\n1 1 5 0.7 0.7 0 0\n' > tilted.xyz
printf 'x y z normal_x normal_y normal_z\n0 0 5 0 0 1\n1 1 5 0 0 0\n' > aimless.xyz
printf 'x y z normal_x normal_y normal_z\n0 0 5 0 0 1\n1 1 5 0 0 -1\n' > under.xyz
: > empty
refused() { # MESSAGE PATH [STOCK [CUTTER [OPTION...]]]
    local message=$1 path=$2 stock=${3:-box:0,0,0,9,9,9} cutter=${4:-ball:6}
    shift $(($# < 4 ? $# : 4))
    "$HERE/../refuses" "$message" fettle-mill "$path" --stock "$stock" --cutter "$cutter" --step 0.5 "$@"
}
box=box:0,0,0,9,9,9
refused "cycle.nc: line 2: 'G81' is not accepted" cycle.nc
refused 'feed.nc: line 2: a feed move, but no F yet' feed.nc
refused 'nan.xyz: point 2: not a finite position' nan.xyz
refused 'one.xyz: a path needs two points or more' one.xyz
refused 'slow.xyz: point 2: feed must be at least 0, got -1' slow.xyz
refused 'tilted.xyz: point 2: the cutter' tilted.xyz
refused 'contact points need normal_x' path.xyz $box ball:6 --points cc
refused 'aimless.xyz: point 2: its normal has no direction' aimless.xyz $box ball:6 --points cc
refused 'under.xyz: point 2: ' under.xyz $box ball:6 --points cc
refused 'a program has no contact points' feed.nc $box ball:6 --points cc
refused 'empty' empty
refused 'missing.nc' missing.nc
printf '#1=3\nG0 X#1\n' > parameter.nc
printf 'o<cut> sub\n' > sub.nc
printf 'G0 X0 Y0 Z5\nX[1+2]\n' > expression.nc
printf 'G0 X0 Y0 Z5\nG20 G1 X1 F10\n' > unit.nc
printf 'G54 G0 X0 Y0 Z5\nG55 X1\n' > systems.nc
refused "parameter.nc: line 1: expected a word, got '#1=3': parameters (#) and expressions ([ ]) are not read" parameter.nc
refused "sub.nc: line 1: O-words (subprograms, loops) are not read, got 'O<CUT>'" sub.nc
refused "expression.nc: line 2: expected a number after X, got '[1+2]': parameters" expression.nc
refused 'unit.nc: line 2: F on a line that changes the unit' unit.nc
refused 'systems.nc: line 2: a move with the coordinate system G55 after moves with G54' systems.nc
refused '--stock: a box needs x0 < x1' path.xyz box:0,0,0,0,9,9
refused '--stock: expected a number for y1 and a comma' path.xyz box:0,0,0,9,9
refused '--stock: expected a number for z1' path.xyz box:0,0,0,9,9,9,9
refused '--stock: a cell of' path.xyz box:0,0,0,90000,90000,9
refused 'missing.stl' path.xyz missing.stl
refused '--cutter: the diameter must be positive' path.xyz $box ball:0
refused '--cutter: expected ball:D' path.xyz $box drill:3
refused '--cutter: a corner of radius 4' path.xyz $box bull:6,4
refused '--holder: both must be positive' path.xyz $box ball:6 --holder 20,-3
refused '--ascii: points are written with --pcd' path.xyz $box ball:6 --ascii
refused '--feed' path.xyz $box ball:6 --feed 0
refused 'a box is in mm' path.xyz $box ball:6 --stock-units in
refused '--cutter: the diameter must be in' path.xyz $box ball:1e200
refused '--cutter: the half angle must be in' path.xyz $box taper:6,1e-300,1
refused "--cutter: the corner's radius must be in" path.xyz $box bull:6,1e-300
refused '--holder: the height must be in' path.xyz $box ball:6 --holder 20,1e300
refused "--stock: a corner's coordinate must be in" path.xyz box:0,0,0,1e300,9,9
refused '--rapid' path.xyz $box ball:6 --rapid 1e-320
refused '--feed' path.xyz $box ball:6 --feed 1e-320
printf 'OFF\n6 2 0\n0 0 9\n9 0 9\n9 9 9\n0 9 nan\n0 0 nan\n9 0 nan\n3 0 1 2\n3 3 4 5\n' > half.off
refused 'half.off: 1 of 2 facets have NaN or infinite corners' path.xyz half.off
"$HERE/../refuses" 'half.off: 1 of 2 facets have' fettle-mill path.xyz --stock $box --cutter ball:6 --tolerance 0.1 --design half.off
"$HERE/../refuses" 'give either --step or --tolerance' fettle-mill path.xyz --stock $box --cutter ball:6
refused 'give either --step or --tolerance' path.xyz $box ball:6 --tolerance 0.1
refused '--design and --as-published belong to --tolerance' path.xyz $box ball:6 --as-published
"$HERE/../refuses" 'path.xyz: points, expected a mesh' fettle-mill path.xyz --stock $box --cutter ball:6 --tolerance 0.1 --design path.xyz

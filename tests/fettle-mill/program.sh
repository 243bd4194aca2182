# One path as points, as a program, as one in inches and as one of relative words is the same machining: the same
# bytes. Reference: each other.
printf '0 0 10\n10 0 4\n20 8 4\n20 16 10\n' > path.xyz
printf 'G0 X0 Y0 Z10\nG1 X10 Z4 F600\nX20 Y8\nY16 Z10\n' > mm.nc
printf 'G20 G0 X0 Y0 Z0.39370078740157480\nG1 X0.39370078740157480 Z0.15748031496062992 F25\nX0.78740157480314960 Y0.31496062992125984\nY0.62992125984251968 Z0.39370078740157480\n' > inch.nc
printf '%%\n(relative)\nN1 G90 G0 X0 Y0 Z10\nN2 G91 G1 X10 Z-6 F600 ; down\nN3 X10 Y8\nN4 Y8 Z6\nM30\n%%\n' > relative.nc
for path in path.xyz mm.nc inch.nc relative.nc; do
    fettle-mill $path --stock box:-5,-5,0,30,25,9 --cutter bull:8,1.5 --step 0.25 > "$path.stl"
    fettle-diff --tol 1e-5 path.xyz.stl "$path.stl"
done
cmp path.xyz.stl mm.nc.stl
cmp path.xyz.stl relative.nc.stl

# A program that moves before it names its unit is read in mm, as the files without a unit are, and that is said: a control takes
# it in the unit of its configuration. One that names it is not doubted.
how=(--stock box:0,0,0,30,20,9 --cutter ball:6 --step 0.5)
printf 'G90\nG0 X5 Y5 Z12\nG1 X20 F600\n' > none.nc
fettle-mill none.nc "${how[@]}" 2> message > none.stl
[ "$(cat message)" = 'fettle-mill: warning: none.nc: line 2 moves before any G20 or G21: its lengths are taken as mm' ]
sed 's/G90/G90 G21/' none.nc > mm.nc
fettle-mill mm.nc "${how[@]}" 2> message | cmp - none.stl
[ ! -s message ]
printf 'G0 X5 Y5 Z12\nG20\nG1 X0.5 F60\n' > late.nc
fettle-mill late.nc "${how[@]}" 2> message > late.stl
grep -qF 'late.nc: line 1 moves before any G20 or G21' message
# the same of a path that is corrected
fettle-verify none.stl --design none.stl --correct none.nc --corrected corrected.nc --cutter ball:6 2> message > patches.pcd
grep -qF 'none.nc: line 2 moves before any G20 or G21' message

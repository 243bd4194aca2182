# A rapid move through material and a holder that meets it: reported with their lines, exit 1, and the part is there.
# Reference: plain geometry; the rapid goes 3 mm deep, the holder's lower side (10 - 8 = 2 mm below the top) 2 mm.
printf 'G21 G0 X5 Y15 Z20\nX25\nZ8\nG1 Y14 F100\nG0 Z20\n' > rapid.nc
status=0
fettle-mill rapid.nc --stock box:0,0,0,30,30,11 --cutter flat:4 --step 0.5 --report rapid.json > part.stl 2> message || status=$?
[ $status = 1 ]
[ -s part.stl ]
jq -e '.rapid_cuts == {"moves": 1, "first_place": 3, "depth": 3} and .holder_collisions.moves == 0 and
       (.rapid_volume / 37.7 - 1 | fabs) < 0.1' rapid.json > ok
cat message
printf 'G21 G0 X15 Y15 Z20\nG1 Z0 F100\nG0 Z20\n' > deep.nc
status=0
fettle-mill deep.nc --stock box:0,0,-5,30,30,10 --cutter ball:4 --holder 20,8 --step 0.5 --report deep.json > part.stl 2> message || status=$?
[ $status = 1 ]
jq -e '.holder_collisions.moves == 2 and .holder_collisions.first_place == 2 and (.holder_collisions.depth - 2 | fabs) < 1e-9 and
       .rapid_cuts.moves == 0' deep.json > ok
cat message

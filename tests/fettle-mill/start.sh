# A program that begins with a feed move needs --start; with it it cuts as one that goes there first. Relative moves may begin
# there, too. Reference: the same program with the rapid move.
printf 'G91 G1 X20 F600\nY10\n' > relative.nc
printf 'G90 G0 X2 Y3 Z4\nG91 G1 X20 F600\nY10\n' > placed.nc
how=(--stock box:0,0,0,30,20,9 --cutter ball:6 --step 0.5)
"$HERE/../refuses" 'relative.nc: line 1: X is relative (G91) to a position that is not known yet' fettle-mill relative.nc "${how[@]}"
printf 'G1 X20 F600\n' > feed.nc
"$HERE/../refuses" 'feed.nc: line 1: a feed move, but X is not known yet; --start X,Y,Z' fettle-mill feed.nc "${how[@]}"
status=0
fettle-mill relative.nc "${how[@]}" --start 2,3,4 -q --report started.json > started.stl || status=$?
fettle-mill placed.nc "${how[@]}" -q --report placed.json > placed.stl || [ $? = $status ]
cmp started.stl placed.stl
jq -e --slurpfile b placed.json '.feed_length == $b[0].feed_length and .feed_length == 30 and .rapid_length == 0' started.json > ok
"$HERE/../refuses" '--start: expected' fettle-mill feed.nc "${how[@]}" --start 1,2
printf '0 0 5\n9 9 5\n' > path.xyz
"$HERE/../refuses" 'path.xyz: points; --start belongs to a program' fettle-mill path.xyz "${how[@]}" --start 1,2,3
# A second tool is not cut with: that is said.
printf 'T1 M6\nG0 X1 Y1 Z12\nG1 X5 F60\nT2 M6\nX9\n' > two.nc
fettle-mill two.nc "${how[@]}" 2> message > two.stl
grep -qF 'two.nc: line 4 changes the tool: the moves after it are cut with the same --cutter' message

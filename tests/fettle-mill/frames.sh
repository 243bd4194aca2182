# Pictures while a block is milled: at equal times until the last move's end. Reference: the report's time.
{ printf 'G21 G0 X-5 Y10 Z12\nG1 Z8 F600\n'; for x in $(seq -4 25); do echo "G1 X$x"; done; } >path.nc
fettle-mill path.nc --stock box:0,0,0,20,20,10 --cutter ball:6 --step 0.5 --frames 4 --report mill.json -o machined.stl || [ $? = 1 ]
jq -e '(.frames | length) == 4 and .kind == "frames"' frames/frames.json >/dev/null
jq -es '(.[0].frames[-1].t - .[1].time | fabs) < 1e-6' frames/frames.json mill.json >/dev/null
head -c 4 frames/001.png | tail -c 3 | grep -qx PNG
fettle-mill path.nc --stock box:0,0,0,20,20,10 --cutter ball:6 --step 0.5 -o same.stl || [ $? = 1 ]
cmp machined.stl same.stl

# Layer 1 as G-code in place of the plan, for two controllers: units and feed on lines of their own, straight passes on a plane in
# one move each, at safe height between them. LinuxCNC's C axis turns the head and G64 bounds how far corners are cut; Grbl knows
# neither, and takes lines of less than 80 characters. Reference: the job (10 passes of 2 in at 1 in/s = 60 in/min).
echo '{"kind": "surface", "units": {"length": "in"}, "shape": {"type": "plane", "origin": [0, 0], "z0": 0.75, "slope": [0, 0]}}' > plane.json
jq '.frame.theta_deg = 30' "$SAMPLES/jobs/wang1.json" > turned.json
for dialect in linuxcnc grbl; do
    for job in "$SAMPLES/jobs/wang1.json" turned.json; do
        fettle-plan "$job" plane.json --gcode $dialect > layer1.ngc
        echo "$dialect, $(basename "$job")"
        sed -n '4,/^G1 Z/p' layer1.ngc
        ! grep '^.\{80\}' layer1.ngc || exit 1
        [ "$(tail -n 1 layer1.ngc)" = M30 ]
    done
    fettle-plan "$SAMPLES/jobs/wang1.json" plane.json --gcode $dialect > layer1.ngc
    [ "$(grep -c '^G1 X' layer1.ngc)" = 10 ]
    [ "$(grep -vc '^\((.*)\|G20\|G17 .*\|G64 .*\|F60\|G0 [CZ].*\|G0 X[0-9.]* Y[0-9.]*\|G1 Z0.75\|G1 X[0-9.]* Y[0-9.]* Z0.75\|M30\)$' layer1.ngc)" = 0 ]
done
status=0
fettle-plan "$SAMPLES/jobs/wang1.json" plane.json --gcode fanuc > out 2> message || status=$?
[ $status = 2 ]
[ ! -s out ]
[ "$(wc -l < message)" = 1 ]

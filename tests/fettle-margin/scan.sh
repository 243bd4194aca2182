# A scan says how large the waves about the surface are. Reference: the waves that were put into the scan; that a scan says nothing about where the
# surface is, so one that lies higher and leans gives the same margin; that a scan without waves widens nothing.
cat >job.json <<'JSON'
{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"}, "probe": {"accuracy": 0.05},
 "anomaly": [[-10, -10, 0], [10, -10, 0], [10, 10, 0], [-10, 10, 0]], "sampling": [[-25, -25, 0], [25, -25, 0], [25, 25, 0], [-25, 25, 0]]}
JSON
scan() { # HEIGHT_OF_WAVES LIFT LEAN: a saddle, mm, with noise of 0.005
    awk -v waves="$1" -v lift="$2" -v lean="$3" 'BEGIN {
        srand(1)
        for (y = -28; y <= 28; y += 0.5) for (x = -28; x <= 28; x += 0.5)
            print x, y, x * y / 400 + x * x / 500 + waves * sin(x / 3) * cos(y / 3.5) + lift + lean * x + 0.01 * (rand() + rand() - 1)
    }'
}
scan 0 0 0 >plain.xyz
scan 0.04 0 0 >wavy.xyz
scan 0.04 0.3 0.002 >moved.xyz
fettle-sample job.json --on plain.xyz --strategy wang --noise normal:0.05 --seed 2 >touches.pcd
fettle-fit job.json touches.pcd >surface.json
shift_of() { fettle-margin job.json surface.json "$@" --report report.json >desired.json; jq .shift report.json; }
alone=$(shift_of)
plain=$(shift_of --scan plain.xyz)
wavy=$(shift_of --scan wavy.xyz)
moved=$(shift_of --scan moved.xyz)
echo "shift by touches alone $alone, with a scan without waves $plain, with waves $wavy, moved $moved" >&2
awk -v alone="$alone" -v plain="$plain" -v wavy="$wavy" -v moved="$moved" \
    'BEGIN { exit !(plain < 1.02 * alone && wavy > plain + 0.03 && wavy < plain + 0.2 && moved > 0.97 * wavy && moved < 1.03 * wavy) }'
[ "$(shift_of --scan wavy.xyz --threads 1)" = "$(shift_of --scan wavy.xyz --threads 2)" ]
# in another unit
awk '{ print $1 / 1000, $2 / 1000, $3 / 1000 }' wavy.xyz >metres.xyz
awk -v metres="$(shift_of --scan metres.xyz --scan-units m)" -v wavy="$wavy" 'BEGIN { exit !(metres > 0.999 * wavy && metres < 1.001 * wavy) }'

hills() { # HEIGHT_OF_WAVES: of no family, mm, with noise of 0.005
    awk -v waves="$1" 'BEGIN {
        srand(1)
        for (y = -28; y <= 28; y += 0.5) for (x = -28; x <= 28; x += 0.5)
            print x, y, 0.4 * sin(x / 15) * cos(y / 13 + 0.5) + x * x / 500 + waves * sin(x / 3) * cos(y / 3.5) + 0.01 * (rand() + rand() - 1)
    }'
}
hills 0 >hills.xyz
hills 0.03 >rough.xyz
fettle-sample job.json --on hills.xyz --noise normal:0.05 --seed 2 >touches.pcd
fettle-fit job.json touches.pcd --report fit.json >surface.json
jq -e '.method == "gp"' fit.json
alone=$(shift_of)
hills=$(shift_of --scan hills.xyz)
rough=$(shift_of --scan rough.xyz)
echo "shift of a process by touches alone $alone, with a scan without waves $hills, with waves $rough" >&2
awk -v alone="$alone" -v hills="$hills" -v rough="$rough" 'BEGIN { exit !(hills < 0.8 * alone && hills > 0.3 * alone && rough > hills + 0.02) }'

refuses=$HERE/../refuses
"$refuses" '--scan is for --method posterior' fettle-margin job.json surface.json --method wang --scan wavy.xyz
"$refuses" '--scan-units goes with --scan' fettle-margin job.json surface.json --scan-units mm
awk '$1 < -24' wavy.xyz >beside.xyz
"$refuses" 'beside.xyz: shows the metal around the anomaly at ' fettle-margin job.json surface.json --scan beside.xyz
"$refuses" 'nowhere.xyz' fettle-margin job.json surface.json --scan nowhere.xyz
sed 's/freeform/plane/' job.json >plane.json
fettle-fit plane.json touches.pcd >plane-surface.json
"$refuses" 'plane-surface.json: is no free-form surface fitted to touches' fettle-margin plane.json plane-surface.json --scan wavy.xyz

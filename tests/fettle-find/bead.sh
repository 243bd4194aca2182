# A weld bead on a hammer's scan is found where it is, and nothing else as high. Reference: what fettle-part has added to the scan, by
# volume and height.
fettle-part "$SAMPLES/parts/hammer.json" -o worn.stl
status=0
fettle-find worn.stl --min-height 0.5 --report found.json --format ply -o labelled.ply || status=$?
[ $status = 1 ]
jq -e '.kind == "found" and .units.length == "mm" and (.anomalies | length) == 1' found.json > ok
jq -e '.anomalies[0] | .anomaly == 1 and .probability > 0.8 and .height > 2.2 and .height < 3.3 and .significance > 30' found.json > ok
# The volume between the part and its bare scan, in mm³, within a fifth: the surface beneath is an estimate.
fettle-compare worn.stl --to "$SAMPLES/scans/hammer.stl" --tolerance 0.2 --report errors.json -o errors.pcd || [ $? = 1 ]
jq -e --slurpfile e errors.json '.anomalies[0].volume / $e[0].under_cut_volume - 1 | fabs < 0.2' found.json > ok
# The mesh has kept its triangles, and its vertices have the two fields.
fettle-diff labelled.ply worn.stl
grep -a -c -E '^property float (scalar_)?(anomaly|height)' labelled.ply > lines
[ "$(cat lines)" = 2 ]

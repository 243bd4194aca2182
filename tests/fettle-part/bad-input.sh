# What a specification may not say: exit 2, one line that names the file and the place, nothing on stdout.
refused() { # PATTERN JQ-FILTER [PART]
    jq "$2" "$SAMPLES/parts/${3:-wang1}.json" >bad.json
    status=0
    fettle-part bad.json >out 2>err || status=$?
    [ $status -eq 2 ] && [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ] && grep -q "^fettle-part: .*$1" err ||
        { echo "not refused as expected: $2 (status $status)"; cat err; exit 1; }
}
refused 'kind' '.kind = "job"'
refused 'units' 'del(.units)'
refused 'units.length' '.units.length = "inch"'
refused 'step' '.step = 0'
refused 'bad.json: step: too fine' '.step = 1e-5'
refused 'bad.json: step: too fine' '.step = 1e-100 | .region.x = [0, 1e-100]'
refused 'stepp' '.stepp = 1'
refused 'region.x' '.region.x = [3, 0]'
refused 'surface.type' '.surface.type = "plain"'
refused 'bad.json: surface: is not defined over (0, 0) in' '.surface.radius = 1' wang3
refused 'surface.section' '.surface.section = [[0, 0], [1, 1]]' hills
refused 'surface.section' '.surface.section[2][0] = -2' hills
refused 'give either scan or surface, not both' '.scan = {"file": "a.stl", "units": "mm"}'
refused 'noise' '.noise = "gauss:1"'
refused 'anomalies\[0\].type' '.anomalies[0].type = "wart"'
refused 'anomalies\[0\].*draft_deg' '.anomalies[0].draft_deg = 0'
refused 'anomalies\[0\].*outline' '.anomalies[0].outline = {}'
refused 'stroke' '.anomalies[0].outline.letter_h.stroke = 1'
refused 'polygon' '.anomalies[0].outline.polygon = [[0, 0], [1, 1]]' wang3
refused 'polygon' '.anomalies[0].outline.polygon = [[0, 0], [1, 1], [2, 2]]' wang3
refused 'bite' '.anomalies[0].outline.moon.bite.centre = [9, 9]' moon
refused 'anomalies\[1\].*height' '.anomalies[1].height = 1' wang2
refused 'anomalies\[0\].*height' '.anomalies[0].height = 9' wang2
refused 'roughness.size' '.anomalies[0].roughness.size = 1' wang3
refused 'bad.json: anomalies\[1\]: is outside the part' '.anomalies[1].centre = [9, 9]' wang2
# A square of two triangles, which an anomaly would cut into more than the memory holds.
printf 'v 0 0 0\nv 99 0 0\nv 99 99 0\nv 0 99 0\nf 1 2 3 4\n' >square.obj
refused 'bad.json: step: too fine' '.step = 1e-5 | .scan = {"file": "square.obj", "units": "mm"}
    | .anomalies = [{"type": "dot", "centre": [50, 50], "radius": 40, "height": 1}] | del(.region)' hammer
refused 'nowhere.stl' '.scan.file = "nowhere.stl"' hammer
for content in '' '{' '[]' '{"kind": "part", "kind": "part"}'; do
    status=0
    printf '%s' "$content" | fettle-part >out 2>err || status=$?
    [ $status -eq 2 ]
    [ ! -s out ]
    [ "$(wc -l <err)" -eq 1 ]
done

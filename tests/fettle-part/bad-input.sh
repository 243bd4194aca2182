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
refused 'step: too fine' '.step = 1e-5'
refused 'stepp' '.stepp = 1'
refused 'region.x' '.region.x = [3, 0]'
refused 'surface.type' '.surface.type = "plain"'
refused 'not defined over' '.surface.radius = 1' wang3
refused 'surface.section' '.surface.section = [[0, 0], [1, 1]]' hills
refused 'surface.section' '.surface.section[2][0] = -2' hills
refused 'stands beside a surface' '.scan = {"file": "a.stl", "units": "mm"}'
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
refused 'anomalies\[1\].*beside the part' '.anomalies[1].centre = [9, 9]' wang2
refused 'nowhere.stl' '.scan.file = "nowhere.stl"' hammer
for content in '' '{' '[]' '{"kind": "part", "kind": "part"}'; do
    status=0
    printf '%s' "$content" | fettle-part >out 2>err || status=$?
    [ $status -eq 2 ] && [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ]
done

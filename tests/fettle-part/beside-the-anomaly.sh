# In S without B a part with anomalies is the same surface as without, and inside B nothing lies below it. Reference: the truth part; 1e-4 in
# is twice the chord of a triangle (0.03 in over a radius of 4 in: 5.6e-5), whose corners differ where anomalies are.
# (fettle-compare says 1: out of the job's tolerance, as the anomaly is.)
for part in wang1 wang2 wang3; do
    fettle-part --without-anomaly "$SAMPLES/parts/$part.json" -o truth.stl
    fettle-part --cloud "$SAMPLES/parts/$part.json" |
        fettle-compare - --to truth.stl --within "$SAMPLES/jobs/$part.json" --mode z --report $part.json >/dev/null || [ $? -eq 1 ]
    jq -e '.regions.around.max < 1e-4 and .regions.around.min > -1e-4 and .regions.inside.min > -1e-4' $part.json >/dev/null
done
# The H is 0.5 in high at its farthest edge, where the wall begins 0.088 in earlier: 0.25 + 0.25 (1.7 - 0.088) / 1.7.
jq -e '.regions.inside.max > 0.486 and .regions.inside.max < 0.488' wang1.json >/dev/null

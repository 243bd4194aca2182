# The boundaries lie on the part's top also where its underside shows through: of a plate scanned from both sides, whose top is sparse and
# has gaps and whose underside is dense, and of one three times as thick; also where the corners have no z. No point of a line is
# off the top by more than the top's own roughness. Reference: the plate's top, by its formula.
job() { # Z
    cat <<JOB
{ "kind": "job", "units": {"length": "mm", "force": "N"}, "surface": {"type": "freeform"},
  "anomaly": [[12, 12$1], [30, 14$1], [26, 31$1], [14, 28$1]], "sampling": [[5, 5$1], [38, 6$1], [36, 37$1], [4, 35$1]] }
JOB
}
job '' >flat.json
job ', 0.5' >level.json
for thickness in 2 6; do
    # The top every 1.2 mm, and two of its rows are missing; the underside every 0.4 mm.
    awk -v thickness=$thickness 'function top(x, y) { return 0.5 * sin(x / 9) * cos(y / 7) }
        BEGIN { for (y = 0; y <= 42; y += 1.2) for (x = 0; x <= 42; x += 1.2) if (!(x > 19 && x < 20) && !(y > 20 && y < 21)) print x, y, top(x, y)
                for (y = 0; y <= 42; y += 0.4) for (x = 0; x <= 42; x += 0.4) print x, y, -thickness }' >part-$thickness.xyz
    for job in flat level; do
        fettle-view part-$thickness.xyz --within $job.json -o $thickness-$job.html
    done
done
python3 - *.html <<'PYTHON'
import json, math, re, sys
for name in sys.argv[1:]:
    scene = json.loads(re.search(r'class="scene">(.*?)</script>', open(name).read(), re.S).group(1))
    assert set(scene["boundaries"]) == {"B", "S"}
    for boundary, found in scene["boundaries"].items():
        off = [abs(z - 0.5 * math.sin(x / 9) * math.cos(y / 7)) for x, y, z in found["line"]]
        assert len(off) > 100 and max(off) < 0.3, (name, boundary, len(off), max(off))
PYTHON

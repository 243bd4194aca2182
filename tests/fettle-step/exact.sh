# Distances to the surfaces themselves: points round the B-spline ring of the clamp, radii 20 and 4 about (30, 20, 40), whatever the triangles. Reference: the torus.
design=$SAMPLES/designs/clamp.step
awk 'BEGIN { for (i = 0; i < 2000; i++) { a = i * 0.61; b = i * 0.173; r = 4 + 2 * sin(i); R = 20 + r * cos(b)
    if (40 + r * sin(b) > 38) printf "%.3f %.3f %.3f\n", 30 + R * cos(a), 20 + R * sin(a), 40 + r * sin(b) } }' > points.xyz
fettle-step "$design" --tolerance 0.1 --exact points.xyz --report r.json -o map.csv
tail -n +2 map.csv | tr , ' ' | paste -d ' ' points.xyz - | awk '{ r = sqrt(($1 - 30)^2 + ($2 - 20)^2) - 20; e = sqrt(r * r + ($3 - 40)^2) - 4 - $10; n++; if (e > 1e-6 || e < -1e-6) bad++ }
    END { exit !(n > 1000 && bad == 0) }'
jq -e '.count > 1000 and .undefined == 0 and .min < -1.9 and .max > 1.9' r.json > /dev/null
# The same in inches; of a mesh the vertices are measured, which lie on the design but for their rounding.
awk '{ print $1 / 25.4, $2 / 25.4, $3 / 25.4 }' OFMT=%.9g points.xyz > inches.xyz
fettle-step "$design" --tolerance 0.004 --units in --exact inches.xyz --report inches.json -o inches.pcd
fettle-step "$design" --tolerance 0.1 --exact points.xyz --format pcd > mm.pcd
fettle-step "$design" --tolerance 0.1 -o mesh.stl
fettle-step "$design" --tolerance 0.1 --exact mesh.stl --report mesh.json -o vertices.ply
jq -e '.min > -1e-5 and .max < 1e-5' mesh.json > /dev/null
grep -aq 'units in' inches.pcd
jq -e --slurpfile mm r.json '(.max * 25.4 - $mm[0].max | fabs) < 1e-5 and (.rms * 25.4 - $mm[0].rms | fabs) < 1e-5' inches.json > /dev/null
fettle-step "$design" --tolerance 0.1 --exact points.xyz --threads 1 | cmp - mm.pcd

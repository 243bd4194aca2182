# A laser profiler's list as it is: 0.2 mm between points, 1 to 12 mm between profiles. Its weld, which the height map of the points alone does not show,
# is found in their order. Reference: the same points as triangles of fettle-reconstruct, rounded to a PLY's floats.
fettle-find "$SAMPLES/scans/weld.txt.gz" --file-units m --units mm --report found.json -o found.pcd -q || [ $? = 1 ]
fettle-reconstruct "$SAMPLES/scans/weld.txt.gz" --file-units m --units mm -q -o weld.ply
fettle-find weld.ply --report mesh.json -o mesh.ply -q || [ $? = 1 ]
jq -e --slurpfile mesh mesh.json '(.anomalies | length == 2) and ([.anomalies, $mesh[0].anomalies] | transpose | all(.[0].height / .[1].height - 1 | fabs < 0.05))' found.json > ok
# All points are there, in their order.
[ "$(sed -n 's/^POINTS //p' found.pcd)" = "$(zcat "$SAMPLES/scans/weld.txt.gz" | wc -l)" ]

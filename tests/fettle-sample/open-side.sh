# An anomaly at a part's edge: its sampling area is open on one side, where the layout has no room. The touches go where there is room, all in
# S and outside of B; by Wang's rules alone the job is refused. Reference: the plane that is touched.
awk 'BEGIN { for (y = 0; y <= 60; ++y) for (x = 0; x <= 60; ++x) print x, y, 0.02 * x }' > part.xyz
cat > job.json << 'END'
{"kind": "job", "units": {"length": "mm", "force": "N"}, "anomaly": [[0, 20], [20, 20], [20, 40], [0, 40]],
 "sampling": [[0, 5], [40, 5], [40, 55], [0, 55]], "probe": {"accuracy": 0.05, "tip_radius": 0}, "tolerance": 0.2, "surface": {"type": "freeform"}}
END
fettle-sample job.json --on part.xyz -o samples.pcd 2> said
grep -q 'no room to touch on both sides of the anomaly.*; touched adaptively' said
fettle-fit job.json samples.pcd | fettle-mesh - --within job.json --step 2 -o desired.pcd
fettle-clean desired.pcd --format csv | awk -F , 'NR > 1 { d = $3 - 0.02 * $1; if (d > 0.05 || d < -0.05) exit 1 } END { exit NR < 50 }'
"$HERE/../refuses" 'no room to touch on both sides of the anomaly' fettle-sample job.json --on part.xyz --strategy wang
# A plane is touched at the anomaly's boundary points, but for those on the open side, which the anomaly hangs over: they stand 3 mm higher here.
awk 'BEGIN { for (y = 0; y <= 60; ++y) for (x = 0; x <= 60; ++x) print x, y, 0.02 * x + (x <= 2 && y >= 15 && y <= 45 ? 3 : 0) }' > hung.xyz
jq '.surface.type = "plane" | .anomaly = [[0, 20], [10, 20], [20, 20], [20, 40], [10, 40], [0, 40]]' job.json > plane.json
fettle-sample plane.json --on hung.xyz | fettle-fit plane.json | jq -e '.shape.slope[0] > 0.019 and .shape.slope[0] < 0.021 and (.shape.slope[1] | fabs) < 0.001'
jq '.anomaly = [[0, 20], [20, 20], [20, 40], [0, 40]]' plane.json > narrow.json
fettle-sample narrow.json --on hung.xyz -o samples.pcd 2> said
grep -q 'only 2 boundary points of the anomaly have room to touch beyond them, a plane needs 4.*; touched adaptively' said
"$HERE/../refuses" 'only 2 boundary points of the anomaly have room to touch beyond them' fettle-sample narrow.json --on hung.xyz --strategy wang

# What is no surface, has no grid, or no sigma; command lines.
refuses=$HERE/../refuses
echo '{"kind": "surface", "units": {"length": "mm"},
  "shape": {"type": "plane", "origin": [0, 0], "z0": 1, "slope": [0.5, 0]}}' >surface.json
echo '1 2 3' >one.xyz
: >empty
"$refuses" 'stdin: empty, expected JSON' fettle-mesh --step 1 </dev/null
"$refuses" 'empty: empty, expected JSON' fettle-mesh empty --step 1
"$refuses" 'empty' fettle-mesh surface.json --at empty
"$refuses" 'give either --at POINTS or --step LENGTH' fettle-mesh surface.json
"$refuses" 'give either --at POINTS or --step LENGTH' fettle-mesh surface.json --at one.xyz --step 1
"$refuses" '--within and --stl belong to --step' fettle-mesh surface.json --at one.xyz --stl
"$refuses" '--step' fettle-mesh surface.json --step 0
"$refuses" '--step' fettle-mesh surface.json --step nan
"$refuses" 'only one of SURFACE and --at can be stdin' fettle-mesh --at - <surface.json
"$refuses" 'surface.json: has no covariance' fettle-mesh surface.json --at one.xyz --sigma
"$refuses" 'surface.json: has no touches' fettle-mesh surface.json --step 1
"$refuses" 'surface.json: kind: expected "job"' fettle-mesh surface.json --step 1 --within surface.json
echo '{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "plane"},
  "anomaly": [[5, 5], [15, 5], [15, 15], [5, 15]]}' >job.json
"$refuses" 'points is too fine' fettle-mesh surface.json --step 1e-4 --within job.json
"$refuses" 'job.json: kind: expected "surface", got "job"' fettle-mesh job.json --step 1
sed 's/"z0"/"zo"/' surface.json >typo.json
"$refuses" 'typo.json: shape.z0: missing' fettle-mesh typo.json --step 1
"$refuses" '/dev/full' fettle-mesh surface.json --at one.xyz -o /dev/full

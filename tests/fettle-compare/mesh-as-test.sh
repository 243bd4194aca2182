# A mesh is tested at its vertices, read from a pipe; its areas give the volumes. Reference: a plate 0.5 above another.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n' >plate.obj
sed 's/ 0$/ 0.5/' plate.obj >raised.obj
fettle-compare - --to plate.obj --report report.json <raised.obj >errors.pcd
jq -e '.count == 4 and .mean == 0.5 and .under_cut_volume == 50 and .over_cut_volume == 0' report.json >/dev/null
fettle-compare plate.obj --to raised.obj --report report.json >errors.pcd
jq -e '.mean == -0.5 and .under_cut_volume == 0 and .over_cut_volume == 50' report.json >/dev/null

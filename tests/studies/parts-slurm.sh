# Parts sent to the nodes of a real Slurm give the same bytes as on this machine, in the table, the JSON, the ground part, its errors and the index; each part
# is a job of its own. Reference: the run without Slurm, and the controller's log.
for program in slurmctld slurmd munged srun; do
    PATH=$PATH:/usr/sbin command -v $program >/dev/null ||
        { echo "$program is not installed (apt-get install slurmctld slurmd slurm-client munge)"; exit 77; }
done
root=$HERE/../..
build=$(dirname "$(dirname "$(command -v fettle-find)")")
unset MAKEFLAGS MFLAGS MAKELEVEL
mkdir scans
for height in 0.8 1.2; do
    echo '{"kind": "part", "units": {"length": "mm"}, "surface": {"type": "plane", "point": [0, 0, 0]}, "region": {"x": [-15, 15], "y": [-15, 15]},
        "step": 1, "anomalies": [{"type": "hill", "centre": [0, 0], "semi_axes": [4, 3], "height": '$height'}]}' | fettle-part -o "scans/hill-${height#?.}.stl"
    jq '.units = {"length": "mm", "force": "N"} | .surface = {"type": "plane"} | .tolerance = 0.4 | .safe_height = 10 | del(.frame) | del(.wheel.origin)
        | .anomaly = [[-5, -5, 0], [5, -5, 0], [5, 5, 0], [-5, 5, 0]] | .sampling = [[-12, -12, 0], [12, -12, 0], [12, 12, 0], [-12, 12, 0]]' \
        "$SAMPLES/jobs/crown.json" >"scans/hill-${height#?.}.json"
done
parts() { # FOLDER [make options]
    make --no-print-directory -s -C "$root" -f pipelines/parts.mk B="$build" PARTS="$PWD/$1" SCANS="$PWD/scans" TEMPLATE="$PWD/scans/hill-8.json" CLEAN=no all "${@:2}" >"$1.table" 2>"$1.log"
}
parts local
work=$(mktemp -d /tmp/parts.XXXXXX) # a short path, for a socket; munge refuses one where others may not enter
chmod 755 "$work"
trap '"$root"/pipelines/cluster/slurm stop "$work/slurm"; rm -rf "$work"' EXIT
eval "$("$root"/pipelines/cluster/slurm start "$work/slurm")"
parts nodes -j4 LAUNCH='srun -Q -n1 -c1 --quit-on-interrupt'
[ "$(grep -c '_job_complete: JobId=[0-9]* done' "$work/slurm/slurmctld.log")" = 2 ]
[ "$(grep -c '^"hill-[0-9]","within",1,' local.table)" = 2 ]
cmp local.table nodes.table
for file in hill-8/part.json hill-2/part.json hill-8/1/errors.pcd hill-2/1/errors.pcd hill-8/1/ground.pcd index.html; do cmp "local/$file" "nodes/$file"; done

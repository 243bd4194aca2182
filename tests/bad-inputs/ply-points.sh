# PLY that is malformed or unusual, in every place where a tool reads points; within the bounds of probe.bash.
# shellcheck source=tests/bad-inputs/ply-obj.bash
. "$HERE/ply-obj.bash"
for file in bad/*.ply; do case $file in */list-* | */index* | */no-end.ply) ;; *) points R "$file" ;; esac done
for file in unusual/*.ply; do points S "$file"; done
fettle-compare good.pcd --to unusual/big-endian.ply -q -o errors.pcd
all_tried 800

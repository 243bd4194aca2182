# PLY that is malformed or unusual, in every place where a tool reads a mesh; within the bounds of probe.bash.
# shellcheck source=tests/bad-inputs/ply-obj.bash
. "$HERE/ply-obj.bash"
meshes G good.ply
for file in bad/*.ply; do meshes R "$file"; done
for file in unusual/*.ply; do meshes S "$file"; done
all_tried 650

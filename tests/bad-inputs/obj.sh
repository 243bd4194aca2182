# OBJ that is malformed or unusual, in every place where a tool reads a mesh; within the bounds of probe.bash.
# shellcheck source=tests/bad-inputs/ply-obj.bash
. "$HERE/ply-obj.bash"
meshes G good.obj
for file in bad/*.obj; do meshes R "$file"; done
for file in unusual/*.obj; do meshes S "$file"; done
all_tried 300

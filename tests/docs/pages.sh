# The pages in docs/tools are what --help says (make docs writes them).
root=$HERE/../..
for source in "$root"/tools/fettle-*.cc; do
    tool=$(basename "$source" .cc)
    case $tool in fettle-gantry-linuxcnc | fettle-step) command -v "$tool" > /dev/null || continue ;; esac # built where LinuxCNC's, OpenCASCADE's headers are
    diff -u "$root/docs/tools/$tool.md" <("$root/tests/tool-page" "$(command -v "$tool")")
done
# The list of all tools names these where they were built.
if command -v fettle-gantry-linuxcnc > /dev/null && command -v fettle-step > /dev/null; then
    diff -u "$root/docs/tools/fettle.md" <("$root/tests/tool-page" "$(command -v fettle)")
fi

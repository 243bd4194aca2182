# The pages in docs/tools are what --help says (make docs writes them).
root=$HERE/../..
for source in "$root"/tools/fettle-*.cc; do
    tool=$(basename "$source" .cc)
    [ "$tool" != fettle-gantry-linuxcnc ] || command -v "$tool" > /dev/null || continue # built where LinuxCNC's headers are
    diff -u "$root/docs/tools/$tool.md" <("$root/tests/tool-page" "$(command -v "$tool")")
done
# The list of all tools names fettle-gantry-linuxcnc where that was built.
if command -v fettle-gantry-linuxcnc > /dev/null; then
    diff -u "$root/docs/tools/fettle.md" <("$root/tests/tool-page" "$(command -v fettle)")
fi

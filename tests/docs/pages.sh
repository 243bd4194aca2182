# The pages in docs/tools are what --help says (make docs writes them).
root=$HERE/../..
for source in "$root"/tools/fettle-*.cc; do
    tool=$(basename "$source" .cc)
    [ "$tool" != fettle-gantry-linuxcnc ] || command -v "$tool" > /dev/null || continue # built where LinuxCNC's headers are
    diff -u "$root/docs/tools/$tool.md" <("$root/tests/tool-page" "$(command -v "$tool")")
done

# The example of each help text runs as pasted, in a copy of samples/; exit 1 (the answer is no) is an answer.
cp -r "$SAMPLES" samples
cd samples
chmod -R u+w .
for source in "$HERE"/../../tools/fettle-*.cc; do
    tool=$(basename "$source" .cc)
    [ "$tool" != fettle-gantry-linuxcnc ] || continue # its machine has to run: tests/linuxcnc
    [ "$tool" != fettle-step ] || command -v "$tool" > /dev/null || continue # built where OpenCASCADE is
    example=$("$tool" --help | sed -n '/^Example/{n;s/^ *//;p}')
    test -n "$example"
    status=0
    bash -o pipefail -c "$example" >stdout 2>stderr || status=$?
    test $status -le 1 || { echo "$tool: $example"; cat stderr; false; }
done

# The pipeline at the head of the README runs as pasted and leaves its picture.
cp -r "$SAMPLES" samples
chmod -R u+w samples
sed -n '/^```sh/,/^```/p' "$HERE/../../README.md" | sed '1d; /^```/,$d' >pipeline
bash -euo pipefail pipeline
test -s samples/errors.png

# The second tutorial, followed word by word like the first. Merging twelve scans takes most of two minutes of processor time: make test leaves it
# to make test-all.
[ "${FETTLE_DRAWS:-all}" = all ] || { echo "two minutes: make test-all"; exit 77; }
cp -r "$SAMPLES" samples
chmod -R u+w samples
"$HERE/run-page" "$HERE/../../docs/tutorial-robot.md" --check-numbers

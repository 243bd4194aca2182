# The tutorial, followed word by word: its commands print what the page shows, every number of its sentences is one of
# those, and the pictures that they draw are the page's, byte for byte. Reference: the page (make bless TOOL=docs updates it).
cp -r "$SAMPLES" samples
chmod -R u+w samples
"$HERE/run-page" "$HERE/../../docs/tutorial.md" --check-numbers

# The tutorial, followed word by word: what its commands print is what the page tells, every number of its sentences is one of
# those, and the pictures that they draw are the page's, byte for byte. Reference: the page (make bless TOOL=docs makes it anew).
cp -r "$SAMPLES" samples
chmod -R u+w samples
"$HERE/run-page" "$HERE/../../docs/tutorial.md" --told-by-page

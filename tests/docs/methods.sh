# The validation of each method: its commands run as pasted, and print the figures that the page tells. Reference: the pages.
for page in "$HERE"/../../docs/methods/*.md; do
    rm -rf here
    mkdir here
    cp -r "$SAMPLES" here/samples
    chmod -R u+w here
    (cd here && "$HERE/run-page" "$page")
done

# shellcheck shell=bash
# The commands of pages of docs/methods run as pasted, and print the figures that the page tells.    follow PAGE...
follow() {
    for page in "$@"; do
        rm -rf here
        mkdir here
        cp -r "$SAMPLES" here/samples
        chmod -R u+w here
        (cd here && "$HERE/run-page" "$HERE/../../docs/methods/$page.md")
    done
}

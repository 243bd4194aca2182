# The validation of the other methods: registration, comparison, belt, robot, milling. Reference: the pages.
# shellcheck source=tests/docs/methods.bash
. "$HERE/methods.bash"
follow scans alignment comparison belt-contact belt-grinding robot machining

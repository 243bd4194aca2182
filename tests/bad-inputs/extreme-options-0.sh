# Extreme options of one half of the tools (extreme-options.bash).
half=0
# shellcheck source=tests/bad-inputs/extreme-options.bash
. "$HERE/extreme-options.bash"

# Extreme options of the other half of the tools (extreme-options.bash).
half=1
# shellcheck source=tests/bad-inputs/extreme-options.bash
. "$HERE/extreme-options.bash"

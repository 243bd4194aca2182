# The validation of the methods that the chain from touches to the ground part is made of. Reference: the pages.
# shellcheck source=tests/docs/methods.bash
. "$HERE/methods.bash"
follow touches surfaces margin layers removal gantry

# The recipe of docs/adding-a-tool.md, in a copy of the tree with the library that is already built. Reference: the page.
root=$(realpath "$HERE/../..")
cp -a "$root"/{Makefile,CHANGELOG.md,lib,tools,samples} .
mkdir -p tests/lib tests/fuzz build/bin build/tests docs/tools
cp -a "$root"/tests/{run,refuses,tool-page} tests
cp -a "$root"/tests/lib/precompiled.h tests/lib
cp -a "$root"/tests/fuzz/fuzz.mk tests/fuzz # the Makefile's
ln -s "$BUILD/lib" build
ln -s "$BUILD/tests/lib" build/tests
ln -s "$BUILD/bin/fettle-diff" build/bin
MAKEFLAGS=$(sed -E 's/(^| )B=[^ ]*//g' <<<"${MAKEFLAGS:-}") # of a `make test` with a build folder of its own
export MAKEFLAGS
unset B
"$HERE/run-page" "$HERE/../../docs/adding-a-tool.md"

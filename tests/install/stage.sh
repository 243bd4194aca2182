# What is installed: every tool runs and has its manual page and completion; nothing else lands outside the prefix.
make -s -C "$HERE/../.." install B="$BUILD" DESTDIR="$PWD/stage" PREFIX=/opt/fettle >&2
test "$(ls stage)" = opt && test "$(ls stage/opt)" = fettle
stage=$PWD/stage
cd stage/opt/fettle
for tool in bin/*; do
    name=$(basename "$tool")
    "$tool" --version | grep -q "^$name [0-9]"
    grep -q "^\.TH" "share/man/man1/$name.1"
    test -e "share/bash-completion/completions/$name"
done
test "$(ls bin)" = "$(ls "$BUILD/bin")"

# Completion offers options, and the words of an option.
cat >ask <<'END'
_init_completion() { cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]}; }
_filedir() { :; }
. share/bash-completion/completions/fettle-compare
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1))
_fettle "$1"
echo "${COMPREPLY[*]}"
END
test "$(bash ask fettle-compare --tol)" = --tolerance
test "$(bash ask fettle-compare --mode "")" = "normal z direction"
test "$(bash ask fettle-fit --method cyl)" = cylinder
test "$(bash ask fettle he)" = help
test "$(bash ask fettle help al)" = align

cd "$OLDPWD"
# Another program uses the installed library.
export PKG_CONFIG_PATH=$stage/opt/fettle/lib/pkgconfig CMAKE_PREFIX_PATH=$stage/opt/fettle
"$HERE/../../examples/signed-distance/try" --define-prefix >&2

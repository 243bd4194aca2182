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

cd "$OLDPWD"
# Another program uses the installed library, found by pkg-config or by CMake; reference: distances from a cube's faces.
source=$HERE/../../examples/signed-distance
read -ra flags < <(PKG_CONFIG_PATH=$stage/opt/fettle/lib/pkgconfig pkg-config --define-prefix --cflags --libs fettle)
g++ -std=c++20 "$source/main.cc" "${flags[@]}" -o by-pkg-config
cmake -S "$source" -B cmake-build -DCMAKE_PREFIX_PATH="$stage/opt/fettle" >&2
cmake --build cmake-build >&2

cat >cube.off <<'END'
OFF
8 6 0
0 0 0
10 0 0
10 10 0
0 10 0
0 0 10
10 0 10
10 10 10
0 10 10
4 3 2 1 0
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
END
printf '5 5 12\n5 5 9\n-3 5 -4\n' >points
test "$(./by-pkg-config cube.off <points)" = "$(printf '2\n-1\n5')"
test "$(cmake-build/signed-distance cube.off <points)" = "$(printf '2\n-1\n5')"

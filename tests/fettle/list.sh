# The command that lists the tools: each that is built, once, in the order and the groups of the README's table, with the first words of its
# --help; the page of one; and its refusals. Reference: the README, --help, and the rules of every tool.
refuses=$HERE/../refuses
fettle >list
fettle --help | cmp - list
fettle -h | cmp - list
fettle help | cmp - list
grep -o '^  fettle-[a-z-]*' list | tr -d ' ' >names
diff <(sort names) <(cd "$BUILD/bin" && printf '%s\n' fettle-* | LC_ALL=C sort)
diff names <(grep -oE '^\| \[`fettle-[a-z-]+' "$HERE/../../README.md" | cut -c 5- | grep -xFf names)
diff <(sed -nE 's/^([A-Z][a-z ]+):$/\1/p' list | grep -vx Options) <(sed -nE 's/^\| \*\*([^*]+)\*\* .*/\1/p' "$HERE/../../README.md")
while read -r name about; do
    case $("$name" --help | head -n 1) in "$about"*) ;; *) echo "$name: $about"; exit 1 ;; esac
done < <(grep '^  fettle-' list)
fettle help fit | cmp - <(fettle-fit --help)
fettle help fettle-fit | cmp - <(fettle-fit --help)
fettle-fit --version | head -n 1 | sed 's/fettle-fit/fettle/' | diff - <(fettle --version)
ln -s "$BUILD/bin/fettle" elsewhere
./elsewhere help diff | cmp - <(fettle-diff --help)

"$refuses" "fettle: there is no tool 'zebra' (see fettle --help)" fettle help zebra
"$refuses" "fettle: there is no tool '' (see fettle --help)" fettle ''
"$refuses" "fettle: there is no tool '../bin/fettle-fit'" fettle help ../bin/fettle-fit
"$refuses" 'fettle: the tools are commands of their own: fettle-fit' fettle fit job.json
"$refuses" "fettle: unknown option '--zebra'" fettle --zebra
"$refuses" "fettle: unexpected argument 'b' (see fettle --help)" fettle help fit b
"$refuses" "fettle: there is no tool 'a b'" fettle help $'a\nb'
"$refuses" 'fettle: stdout: cannot write' bash -c 'fettle >/dev/full'
{ fettle; echo $? >status; } 2>err | head -n 1 >first
case $(cat status) in 0 | 141) ;; *) exit 1 ;; esac
test ! -s err

# Files of kinds that no tool reads, in one place of each kind where a tool reads: said to be what they are, with what is expected instead.
# And what never ends: refused by its beginning or by a bound, with its name. Reference: the kinds' first bytes.
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
printf '\211PNG\r\n\032\n0123' >picture
printf '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' >identity
printf '%%PDF-1.4\n%%\342\343\317\323\n1 0 obj\n' >document
cp "$(command -v fettle-diff)" program
gzip -c good.pcd | gzip >packed
printf 'ISO-10303-21;\nHEADER;\n' >step
printf '<!DOCTYPE html>\n<html>\n' >page
head -c 3000 /dev/zero >zeros
perl -e 'srand 1; print pack("C*", map { int rand 256 } 1 .. 100000)' >noise
iconv -t UTF-16LE <good.pcd >wide
: >empty
places() { # FILE WHAT
    is() { tried=$((tried + 1)); "$HERE/../refuses" "$1: $2" "${@:3}" || failed=$((failed + 1)); }
    is "$1" "$2, expected points" fettle-form flatness "$1"
    is "$1" "$2, expected points" fettle-report --trace "$1"
    is "$1" "$2, expected a mesh" fettle-verify "$1" --design plate.stl --step 4
    is "$1" "$2, expected points or a mesh" fettle-compare "$1" --to plate.stl
    is "$1" "$2, expected JSON" fettle-plan "$1" surface.json
    is "$1" "$2, expected JSON" fettle-belt good.pcd --path good.pcd --wheel "$1" --force 5
    is "$1" "$2, expected points or a program" fettle-mill "$1" --stock box:0,0,0,9,9,9 --cutter ball:6 --step 0.5
    is "$1" "$2, expected a transform" fettle-align good.pcd --to plate.stl --transform-in "$1"
    is "$1" "$2, expected picked points" fettle-teach --anomaly "$1" job.json
    is "$1" "$2, expected points or a mesh" fettle-clean "$1"
    is "$1" "$2, expected points or a mesh" fettle-find good.pcd --against "$1" --transform-in identity
    is "$1" "$2, expected points or a mesh" fettle-merge "$1" good.pcd
    is "$1" "$2, expected JSON" fettle-merge good.pcd good.pcd --poses "$1"
    is "$1" "$2, expected points or a mesh" fettle-reconstruct "$1"
    is "$1" "$2, expected points or a mesh" fettle-view "$1"
    is "$1" "$2, expected picked points" fettle-place good.pcd --up "$1"
    is "$1" "$2, expected JSON" fettle-place good.pcd --into "$1"
    is "$1" "$2, expected an SRDF" fettle-arm "$SAMPLES/robots/urdf/ur5.urdf" --srdf "$1" --forward good.pcd
    [ "$1" = empty ] || is "$1" "$2, expected points, a mesh or JSON" fettle-diff "$1" good.pcd
}
places picture 'a PNG picture'
places document 'a PDF document'
places program 'a program (ELF)'
places packed 'compressed by gzip'
places step 'a STEP model'
places page 'an HTML page'
places zeros 'nothing but zero bytes'
places noise 'binary data of no known format'
places wide 'text in UTF-16'
places empty 'empty'
"$HERE/../refuses" 'plate.stl: a mesh, expected points' fettle-path plate.stl
"$HERE/../refuses" "$PWD: cannot read: Is a directory" fettle-path "$PWD"

endless() { # SAYS COMMAND…
    tried=$((tried + 1))
    (ulimit -v 2000000 -t 5; "$HERE/../refuses" "$@") || failed=$((failed + 1))
}
for command in 'form flatness' 'render' 'compare --to plate.stl' 'mill --stock box:0,0,0,9,9,9 --cutter ball:6 --step 0.5' 'verify --design plate.stl' 'diff good.pcd'; do
    # shellcheck disable=SC2086 # words
    endless '/dev/zero: nothing but zero bytes' fettle-$command /dev/zero
done
mkfifo pipe
for command in 'form flatness' 'render' 'compare --to plate.stl' 'diff good.pcd'; do
    yes 1 2 3 >pipe & # until the reader ends
    # shellcheck disable=SC2086 # words
    endless 'pipe: longer than the 488 MiB, a quarter of the memory' fettle-$command pipe
done
all_tried 100

# Point files that lie about themselves, in every place where a tool reads points: refused, within the bounds of probe.bash.
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
points G good.pcd # every place is reached
header() { # KEY VALUE…: of one point of kFields, with lines exchanged; VALUE "-": left out
    local text
    text=$(echo '1 2 3' | rows | pcd "$kFields" | sed -n '1,/^DATA/p')
    while [ $# -gt 0 ]; do
        if [ "$2" = - ]; then text=$(sed "/^$1 /d" <<<"$text"); else text=$(sed "s/^$1 .*/$1 $2/" <<<"$text"); fi
        shift 2
    done
    printf '%s\n' "$text"
}
body() { echo '1 2 3' | rows; }
fields=$(wc -w <<<"$kFields")
repeat() { for ((i = 0; i < fields; i++)); do printf '%s ' "$1"; done | sed 's/ $//'; }
ten() { printf '0123456789'; }
floats() { for ((i = 0; i < $1; i++)); do printf '\0\0\200\77'; done; } # 1.0

: >empty.pcd
header POINTS 5 WIDTH 5 >none-of-5.pcd
{ header POINTS 4294967295 WIDTH 4294967295 DATA binary; ten; } >many.pcd
{ header POINTS 4294967295 WIDTH 4294967295; body; } >many-ascii.pcd
{ header WIDTH 65536 HEIGHT 65536 POINTS 0 DATA binary; ten; } >wrap.pcd
{ header WIDTH -1; body; } >negative.pcd
{ header DATA -; body; } >no-data.pcd
{ header WIDTH - HEIGHT - POINTS -; body; } >no-size.pcd
{ header | sed 's/^# units mm/# units mm N s/'; body; } >three-units.pcd
{ header | sed 's/^# units mm/# units mm kg/'; body; } >no-force.pcd
{ header DATA wrong; body; } >wrong-data.pcd
{ header | sed 's/^DATA.*/DATA/'; body; } >bare-data.pcd
{ header SIZE "$(repeat 0)"; body; } >size-0.pcd
{ header SIZE "$(repeat 3)"; body; } >size-3.pcd
{ header COUNT "$(repeat 0)"; body; } >count-0.pcd
{ header COUNT "$(repeat -1)"; body; } >count-negative.pcd
{ header COUNT "$(repeat 1000000000)" DATA binary; ten; } >count-huge.pcd
{ header SIZE '4 4'; body; } >few-sizes.pcd
{ header FIELDS "${kFields/y/x}"; body; } >two-x.pcd
{ header FIELDS "${kFields/x y z/a b c}"; body; } >no-x.pcd
{ header VIEWPOINT '0 0 0 1 0 0'; body; } >viewpoint-6.pcd
{ header VIEWPOINT '0 0 0 nan 0 0 0'; body; } >viewpoint-nan.pcd
{ header; body | sed 's/ [^ ]*$//'; } >short-row.pcd
{ header; body | sed 's/$/ 7/'; } >long-row.pcd
{ header; body | sed 's/^1 /1,5 /'; } >comma.pcd
{ header | sed 's/^WIDTH/WI\x00TH/'; body; } >nul.pcd
{ header; body; } | iconv -t UTF-16 >utf16.pcd
{ header DATA binary; floats $((fields - 1)); printf '\0\0\200'; } >short.pcd
{ header DATA binary_compressed; printf '\377\377\377\377\377\377\377\377'; ten; } >packed-lies.pcd
# 20 bytes that claim to become what one point needs; the first is a reference to before the beginning
{ header DATA binary_compressed; printf '\24\0\0\0'; printf '\%03o\0\0\0' $((4 * fields)); printf '\340\377\377'; floats 4; printf '\0'; } >packed-corrupt.pcd
{ header; body; header; body; } >twice.pcd
{ header; floats "$fields"; } >mixed.pcd
{ header | sed '/^FIELDS/,$d'; printf 'FIELDS '; head -c 50000000 /dev/zero | tr '\0' x; } >long.pcd
for file in *.pcd; do
    case $file in good.pcd | samples.pcd) ;; *) points R "$file" ;; esac
done
all_tried 800

# Titles, file names and methods that try to be markup stay text. Reference: the XML parser of libxml2, and what it reads.
. "$HERE/run.bash"
evil='</title><script>alert(1)</script>"><img src=x onerror=alert(2)>&amp;'
name='"><img src=y onerror=alert(3)>.json'
cp "$job" "$name"
fettle-report --job "$name" --comparison errors.json --title "$evil" -o page.html
xmllint --noout --nonet page.html
! grep -qE '<(script|img)' page.html || exit 1
test "$(xmllint --xpath 'string(//h1)' page.html)" = "$evil"
test "$(xmllint --xpath 'string(//title)' page.html)" = "$evil"
xmllint --xpath 'string(//section[@id="provenance"])' page.html | grep -qF "$name"
# bytes that are no UTF-8, what steers a terminal, what turns the direction of text
fettle-report --job "$job" --title $'a\xff\e[2Jb\xe2\x80\xaec' -o page.html
xmllint --noout --nonet page.html
test "$(xmllint --xpath 'string(//h1)' page.html)" = $'a\uFFFD\uFFFD[2Jb\uFFFDc'
# noncharacters, which XML does not allow
fettle-report --job "$job" --title $'a\uFFFFb\uFFFEc\U0001FFFFd\uFDD0' -o page.html
xmllint --noout --nonet page.html
test "$(xmllint --xpath 'string(//h1)' page.html)" = $'a\uFFFDb\uFFFDc\uFFFDd\uFFFD'
jq '.fit.method = "<b>quadratic</b>"' desired.json >method.json
fettle-report --surface method.json >page.html || test $? -eq 2
! grep -q '<b>quadratic' page.html || exit 1

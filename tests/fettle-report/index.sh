# The page of many parts: a row each, with links relative to the page. Reference: the reports that it was made of.
printf 'v 0 0 0\nv 9 0 0\nv 9 9 0\nv 0 9 0\nf 1 2 3 4\n' >plate.obj
mkdir pages
for part in 1 2 3; do
    awk -v e="0.0$part" 'BEGIN { for (i = 1; i < 9; i++) for (j = 1; j < 9; j++) print i, j, i == 4 && j == 4 ? e : 0.001 }' >$part.xyz
    fettle-compare $part.xyz --to plate.obj --tolerance 0.025 --report $part.json -o $part.pcd || [ $part = 3 ]
    fettle-report --errors $part.pcd --comparison $part.json --title "Casting $part" --field-in-head "serial=A$part" --report pages/$part.json -o pages/$part.html
done
fettle-report --index pages/*.json -o index.html
xmllint --noout --nonet index.html 2>/dev/null || python3 -c "import xml.dom.minidom; xml.dom.minidom.parse('index.html')"
[ "$(grep -o '<a href="pages/[123].html">Casting [123]</a>' index.html | wc -l)" = 3 ]
grep -q '3 pages: 2 within tolerance, 1 out of tolerance' index.html
grep -q 'data-sort="A2">A2' index.html
grep -q 'data-sort="0.03[0-9]*"' index.html || grep -q 'data-sort="0.02999' index.html
[ "$(grep -o 'src="data:image/png;base64,' index.html | wc -l)" = 3 ]
fettle-report --index pages/2.json pages/1.json --title Series -o pages/some.html # beside the pages, in the order given
grep -o '<a href="[^"]*"' pages/some.html | tr '\n' ' ' | grep -qx '<a href="2.html" <a href="1.html" '
"$HERE/../refuses" '1.json: ' fettle-report --index 1.json
"$HERE/../refuses" '--index: goes without files of one run, such as 1.pcd' fettle-report --errors 1.pcd --index pages/1.json

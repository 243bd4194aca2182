# Beyond an open border and beyond --max-distance the error is NaN, grey, and counted: never guessed.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 1 2 3 4\n' >plate.obj
printf '5 5 0.5\n5 5 2\n10.5 5 0.5\n-1 -1 0\n10 10 0.25\n' >test.xyz
fettle-compare test.xyz --to plate.obj --max-distance 1 --tolerance 1 --ascii --report report.json |
    sed '1,/^DATA/d' | cut -d ' ' -f 1-3,7
jq -e '.count == 2 and .undefined == 3' report.json >/dev/null

# A cube of which one facet is wound the other way, and one that is inside out: repaired, counted and reported; or kept.
# Reference: the distance of the points from the cube, by hand.
cube='v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n'
{ printf "$cube"; printf 'f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n'; } >sound.obj
sed 's/^f 5 6 7 8/f 8 7 6 5/' sound.obj >mixed.obj
sed -E 's/^f (.) (.) (.) (.)/f \4 \3 \2 \1/' sound.obj >inside-out.obj
printf '0.5 0.25 0.75\n0.5 0.25 1.25\n' >test.xyz
for mesh in sound mixed inside-out; do
    for winding in mend keep; do
        fettle-compare test.xyz --to $mesh.obj --winding $winding --format csv --report report.json 2>err | tail -n 2 | cut -d , -f 7 | xargs
        jq -c '[.reference.flipped_facets, .reference.welded_vertices]' report.json
        cat err
    done
done
# An open mesh that is inside out is turned on request.
printf 'v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nf 4 3 2 1\n' >plate.obj
for winding in mend turn; do fettle-compare test.xyz --to plate.obj --winding $winding --format csv | tail -n 1 | cut -d , -f 7; done

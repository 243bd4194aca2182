# What gzip compressed is read by every tool, from files and pipes, and by name; what is cut or damaged is refused, and what grows
# without end is refused before it fills the memory. Reference: the same files, not compressed.
# shellcheck source=tests/bad-inputs/probe.bash
. "$HERE/probe.bash"
good
for file in good.pcd plate.stl job.json; do gzip -c $file > $file.gz; done
fettle-compare good.pcd --to plate.stl --report plain.json -o plain.pcd
fettle-compare good.pcd.gz --to plate.stl.gz --report packed.json -o packed.pcd
cmp plain.pcd packed.pcd
cmp plain.json packed.json
fettle-compare - --to plate.stl -o piped.pcd < good.pcd.gz
cmp plain.pcd piped.pcd
cat good.pcd.gz | fettle-compare - --to <(cat plate.stl.gz) -o piped.pcd
cmp plain.pcd piped.pcd
fettle-form flatness good.pcd --within job.json.gz > form.json
fettle-form flatness good.pcd --within job.json | cmp - form.json
# Members one after the other, as pigz writes them, and a large file, which is read through an unnamed one.
awk 'BEGIN { for (i = 0; i < 300000; ++i) print i % 1000, int(i / 1000), i % 7 }' > large.xyz
(head -n 100000 large.xyz | gzip; tail -n +100001 large.xyz | gzip) > large.xyz.gz
fettle-clean large.xyz -o a.pcd
fettle-clean large.xyz.gz -o b.pcd
cmp a.pcd b.pcd
# Points between commas or semicolons are those between blanks; decimal commas are none.
head -n 1000 large.xyz > some.xyz
fettle-clean some.xyz -o a.pcd
for separator in , ';' ', ' ' ; '; do
    sed "s/ /$separator/g" some.xyz > some.txt
    fettle-clean some.txt -o b.pcd
    cmp a.pcd b.pcd
done
(echo '//X;Y;Z'; tr ' ' ';' < some.xyz) > named.txt
fettle-clean named.txt -o b.pcd
cmp a.pcd b.pcd
printf '1,5 2,5 3,5\n' > decimal.txt
"$HERE/../refuses" "decimal.txt: line 1: '5 2' is not a number" fettle-clean decimal.txt
printf '1,2,3\n4,5,\n' > cut.txt
"$HERE/../refuses" "cut.txt: line 2: '' is not a number" fettle-clean cut.txt

head -c 100000 large.xyz.gz > short.gz
"$HERE/../refuses" 'short.gz: compressed by gzip, and ends too early' fettle-clean short.gz
"$HERE/../refuses" 'stdin: compressed by gzip, and ends too early' bash -c 'cat short.gz | fettle-clean -'
(head -c 50000 large.xyz.gz; printf 'XXXXXXXXXXXXXXXX'; tail -c +50017 large.xyz.gz) > damaged.gz
"$HERE/../refuses" 'damaged.gz: compressed by gzip, and damaged' fettle-clean damaged.gz
{ yes 1 2 3 || true; } | head -c 600000000 | gzip -1 > bomb.gz
(ulimit -v 2000000; "$HERE/../refuses" 'bomb.gz: longer than the 488 MiB' fettle-clean bomb.gz)
(ulimit -v 2000000; "$HERE/../refuses" 'bomb.gz: longer than the 488 MiB' fettle-compare good.pcd --to bomb.gz)

# Touch errors stay inside their interval, follow the seed and nothing else. Reference: the part is z = 0, so z is the
# error; identity for the bytes.
cat > job.json <<'JOB'
{"kind": "job", "units": {"length": "mm"}, "surface": {"type": "freeform"},
 "anomaly": [[30, 30], [180, 30], [180, 190], [30, 190]], "sampling": [[0, 0], [220, 0], [220, 220], [0, 220]]}
JOB
printf 'solid f\nfacet normal 0 0 1\nouter loop\nvertex -9 -9 0\nvertex 999 -9 0\nvertex -9 999 0\nendloop\nendfacet\nendsolid f\n' > part.stl
sample() { fettle-sample job.json --on part.stl --ascii "$@"; }
sample --noise uniform:0.1 --seed 7 > a.pcd
sample --noise uniform:0.1 --seed 7 --threads 1 | cmp a.pcd -
sample --noise uniform:0.1 --seed 7 --threads 2 | cmp a.pcd -
! sample --noise uniform:0.1 --seed 8 | cmp -s a.pcd - || exit 1
grep '^DATA' -A 99 a.pcd | tail -n +2 | awk '{ if ($3 > 0.1 || $3 < -0.1) bad = 1; if ($3 < 0) below = 1; if ($3 > 0) above = 1 }
    END { exit bad || !below || !above }'
# twice the amplitude is twice the error
sample --noise uniform:0.2 --seed 7 | paste a.pcd - | grep '^[0-9.]* [0-9.]* -*[0-9]' |
    awk '{ d = $8 - 2 * $3; if (d > 1e-6 || d < -1e-6) exit 1 }'
"$HERE/../refuses" "--noise: expected uniform:A or normal:A, got 'gauss:1'" fettle-sample job.json --on part.stl --noise gauss:1
"$HERE/../refuses" "--noise: A must be a number, at least 0, got '-1'" fettle-sample job.json --on part.stl --noise uniform:-1
"$HERE/../refuses" "--noise: A must be a number, at least 0, got '1,5'" fettle-sample job.json --on part.stl --noise normal:1,5

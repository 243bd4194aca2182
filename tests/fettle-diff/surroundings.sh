# A file called -x, options after --, no home folder, a locale with decimal commas: all the same. Reference: identity.
p="$HERE/two-points.pcd"
cp "$p" ./-x
fettle-diff --tol 0.5 -- -x "$p"
fettle-diff ./-x "$p"
env -i "$(command -v fettle-diff)" "$p" "$p"
LC_ALL=de_DE.UTF-8 LC_NUMERIC=de_DE.UTF-8 fettle-diff --tol 0.5 "$p" "$p"
mkfifo pipe
cat "$p" > pipe &
fettle-diff pipe "$p"
wait

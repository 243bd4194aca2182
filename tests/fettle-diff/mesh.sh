# Meshes are compared corner by corner, in any format. Reference: by hand.
cat > a.off <<'END'
OFF
4 2 0
0 0 0
1 0 0
1 1 0
0 1 0
3 0 1 2
3 0 2 3
END
cat > b.obj <<'END'
v 0 0 0
v 1 0 0
v 1 1.125 0
v 0 1 0
f 1 2 3
f 1 3 4
END
! fettle-diff a.off b.obj || exit 1
fettle-diff --tol 0.125 a.off b.obj

# The poses of a path turn with it. Reference: a quarter turn about z by hand; there and back is where it was.
cat > path.csv <<'EOF'
x,y,z,qw,qx,qy,qz,stroke
10,0,0,1,0,0,0,0
0,20,5,0.6,0.8,0,0,0
1,2,3,nan,0,0,0,-1
EOF
cat > turned.csv <<'EOF'
x,y,z,qw,qx,qy,qz,stroke
0,10,0,0.7071067811865476,0,0,0.7071067811865476,0
-20,0,5,0.42426407,0.56568542,0.56568542,0.42426407,0
-2,1,3,nan,nan,nan,nan,-1
EOF
fettle-place path.csv --turn z,90 -o placed.csv
fettle-diff --tol 1e-6 placed.csv turned.csv
printf '0.36 0.48 -0.8 10\n-0.8 0.6 0 20\n0.48 0.64 0.6 30\n0 0 0 1\n' > matrix.txt
fettle-place path.csv --matrix matrix.txt --inverse back.txt -o there.csv
fettle-place there.csv --matrix back.txt -o back.csv
sed s/nan,0,0,0/nan,nan,nan,nan/ path.csv | fettle-diff --tol 1e-5 back.csv -
# Joints reach a path where it was.
printf 'x,y,z,joint1\n1,2,3,4\n' > joints.csv
fettle-place joints.csv --turn z,90 -o left.csv 2> warning
grep -q '^fettle-place: warning: joints.csv: its joints reach where it was, and are left out$' warning
[ "$(head -n 1 left.csv)" = x,y,z ]

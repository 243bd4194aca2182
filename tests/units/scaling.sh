# Every report key and field scales as its dimension: the same work in mm, in inches and pounds, and in metres. Reference: docs/formats.md,
# and the definitions of inch and pound.
python3 "$HERE/scaling.py"

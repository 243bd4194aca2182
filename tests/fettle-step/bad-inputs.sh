# What is no design, or not a whole one, is refused in one line. Reference: exit status 2 and the message.
refuses() { "$HERE/../refuses" "$1" fettle-step "${@:2}"; }
cp "$SAMPLES/designs/clamp.step" good.stp
refuses 'missing.stp: cannot open' missing.stp
refuses 'expected a design, STEP' "$SAMPLES/jobs/wang1.json"
head -c 3000 /dev/zero > zeros.stp
refuses 'zeros.stp: nothing but zero bytes, expected a design, STEP or IGES' zeros.stp
: > empty.stp
refuses 'empty.stp: ' empty.stp
head -c 20000 good.stp > cut.stp
refuses 'cut.stp: ' cut.stp
sed 's/SI_UNIT(.MILLI.,.METRE.)/SI_UNIT(.MILLI.,.SECOND.)/' good.stp > unit.stp
refuses "unit.stp: states a unit of length that is not known, 'milli'" unit.stp
sed 's/SI_UNIT(.MILLI.,.METRE.)/SI_UNIT(.MILLI.,.FURLONG.)/' good.stp > furlong.stp
refuses 'furlong.stp: states a unit that is not known: ' furlong.stp
sed 's/MANIFOLD_SOLID_BREP(/MANIFOLD_SOLID_BROP(/' good.stp > none.stp
refuses 'none.stp: has no solid, and no face' none.stp
first=$(grep -m 1 -o '^#[0-9]* = ADVANCED_FACE(' good.stp)
sed "s/^$first/${first%% =*} = ADVANCED_FOCE(/" good.stp > broken.stp
refuses 'cannot be built' broken.stp --tolerance 1
refuses "'.obj' is no format of this output: .stl, .ply, .pcd, .csv, .vtk" good.stp -o x.obj
refuses '--exact: is what writes .pcd; triangles go to .stl or .ply' good.stp -o x.pcd
printf '0 0 0\n1 2 3\n' > points.xyz
refuses '--exact: writes points: .pcd, .ply, .csv or .vtk, not .stl' good.stp --exact points.xyz -o x.stl
refuses 'missing.xyz: cannot open' good.stp --exact missing.xyz
refuses '--tolerance' good.stp --tolerance 0
# What floats cannot hold would take all memory. Reference: they are 3.8e-6 mm apart at 60 mm.
refuses 'clamp.step: reaches to 60 mm, where the floats of the output allow no tolerance under' "$SAMPLES/designs/clamp.step" --tolerance 1e-6
# A surface whose points are missing: OpenCASCADE follows the reference to nowhere, and crashes.
point=$(grep -A 1 -m 1 ' B_SPLINE_SURFACE(' good.stp | grep -o '#[0-9]*' | tail -n 1)
grep -q "^$point = CARTESIAN_POINT" good.stp
sed "/^$point = CARTESIAN_POINT/d" good.stp > dangling.stp
refuses "dangling.stp: OpenCASCADE's reader crashes on it: the file is damaged" dangling.stp

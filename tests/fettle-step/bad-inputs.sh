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
# A cone that is .3 mm wider than its edges, where it meets the other faces.
sed "s/CONICAL_SURFACE('',#495,6.,/CONICAL_SURFACE('',#495,6.3,/" good.stp > wide.stp
refuses "(cone, of 'clamp/pin') is triangulated to 0.296685 mm only, not to 0.05 mm" wide.stp --tolerance 0.05
sed "s/CYLINDRICAL_SURFACE('',#313,8.)/CYLINDRICAL_SURFACE('',#313,1E5)/" good.stp > hall.stp
refuses "(cylinder, of 'clamp/plate') cannot be triangulated" hall.stp --tolerance 0.5
sed "0,/COLOUR_RGB('',[-0-9.E]*,/s//COLOUR_RGB('',-1.,/" good.stp > colour.stp
refuses 'colour.stp: OpenCASCADE cannot read it: ' colour.stp
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
# A solid that is mapped into its product: a shift is read; a scale, which OpenCASCADE leaves out, and a mirror, of which it makes a turn, are refused.
mapped() { # NAME Z-AXIS SCALE
    sed "s/^#44 = ADVANCED_BREP_SHAPE_REPRESENTATION('',(#11,#45),#459);/\
        #9001 = ADVANCED_BREP_SHAPE_REPRESENTATION('',(#11,#45),#459); #9002 = REPRESENTATION_MAP(#11,#9001);\
        #9003 = CARTESIAN_POINT('',(100.,0.,0.)); #9004 = DIRECTION('',(1.,0.,0.)); #9005 = DIRECTION('',(0.,1.,0.)); #9006 = DIRECTION('',(0.,0.,$2));\
        #9007 = CARTESIAN_TRANSFORMATION_OPERATOR_3D('','','',#9004,#9005,#9003,$3,#9006);\
        #9008 = MAPPED_ITEM('',#9002,#9007); #44 = SHAPE_REPRESENTATION('',(#11,#9008),#459);/" good.stp > "$1.stp"
}
mapped shifted 1. 1.
fettle-step shifted.stp --tolerance 1 -q -o shifted.stl
mapped scaled 1. 2.
refuses 'the mapped item #9008 is scaled by 2' scaled.stp --tolerance 1
mapped mirrored -1. 1.
refuses 'the mapped item #9008 is mirrored' mirrored.stp --tolerance 1
sed 's/CARTESIAN_TRANSFORMATION_OPERATOR_3D(.*,#9006)/AXIS2_PLACEMENT3D(\x27\x27,#9003,#9006,#9004)/' shifted.stp > lost.stp
refuses 'the mapped item #9008 is placed in frames that are not found' lost.stp --tolerance 1

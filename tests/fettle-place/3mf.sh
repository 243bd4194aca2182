# 3MF: unit, build items, components with transforms (one mirrors), and what is refused. Reference: the same triangles as OFF, laid by hand.
write() { # OUT.3mf < 3dmodel.model
    python3 -c '
import sys, zipfile
with zipfile.ZipFile(sys.argv[1], "w", zipfile.ZIP_DEFLATED) as z:
    z.writestr("[Content_Types].xml", "<Types/>")
    z.writestr("_rels/.rels", "<Relationships><Relationship Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\" Target=\"/3D/3dmodel.model\" Id=\"r\"/></Relationships>")
    z.writestr("3D/3dmodel.model", sys.stdin.read())' "$1"
}
cat > model.xml <<'X'
<?xml version="1.0" encoding="UTF-8"?>
<model unit="inch" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><metadata name="Title">corner</metadata>
<resources><object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="2" z="0"/><vertex x="0" y="0" z="3"/></vertices>
<triangles><triangle v1="0" v2="2" v3="1"/><triangle v1="0" v2="1" v3="3"/></triangles></mesh></object>
<object id="2"><components><component objectid="1"/><component objectid="1" transform="-1 0 0 0 1 0 0 0 1 -10 0 0"/></components></object></resources>
<build><item objectid="2" transform="0 1 0 -1 0 0 0 0 1 0 0 5"/></build></model>
X
write corner.3mf < model.xml
# p' = (-y, x, z + 5) of the first copy, and of the second, mirrored: (-x - 10, y, z) before
cat > corner.off <<'O'
OFF
8 4 0
0 0 5
0 1 5
-2 0 5
0 0 8
0 -10 5
0 -11 5
-2 -10 5
0 -10 8
3 0 2 1
3 0 1 3
3 4 5 6
3 4 7 5
O
fettle-place corner.3mf --report corner.json -o corner.stl
fettle-place corner.off --file-units in -o reference.stl
fettle-diff --tol 1e-6 corner.stl reference.stl
head -c 80 corner.stl | grep -a -q 'in'
# The unit is the file's: in mm its numbers are 25.4 times as large, and where it is a centimetre they come in mm.
fettle-place corner.3mf --units mm | fettle-diff --tol 1e-4 - <(fettle-place corner.off --file-units in --units mm)
sed 's/"inch"/"centimeter"/' model.xml | write cm.3mf
fettle-place cm.3mf -o cm.stl
sed -e '3,10s/-*[0-9][0-9]*/&0/g' corner.off | sed 's/\b00\b/0/g' > ten.off
fettle-diff --tol 1e-5 cm.stl <(fettle-place ten.off)
refuse() { "$HERE/../refuses" "$1" fettle-place "$2"; }
"$HERE/../refuses" 'corner.3mf: units: the file says in, expected mm' fettle-place corner.3mf --file-units mm
change() { sed "$1" model.xml | write bad.3mf; }
change 's/v3="3"/v3="4"/' && refuse 'bad.3mf: 3D/3dmodel.model: XML, line 4: vertex 4 of a triangle, there are 4' bad.3mf
change 's/v3="3"/v3="-1"/' && refuse "v3: '-1' is no whole number" bad.3mf
change 's/x="1"/x="1,5"/' && refuse "x: '1,5' is no number" bad.3mf
change 's/ y="2"//' && refuse "attribute 'y' is missing" bad.3mf
change 's/unit="inch"/unit="ell"/' && refuse "unit 'ell' is unknown" bad.3mf
change 's/unit=/requiredextensions="p" unit=/' && refuse "requires extensions that are not read: 'p'" bad.3mf
change 's/id="2"/id="1"/' && refuse 'object 1 is defined twice' bad.3mf
change 's/<item objectid="2"/<item objectid="9"/' && refuse 'object 9 does not exist' bad.3mf
change 's/<component objectid="1"/<component objectid="2"/' && refuse 'nested too deep, or in a circle' bad.3mf
change 's/<item .*<\/build>/<\/build>/' && refuse 'nothing is built' bad.3mf
change 's/transform="0 1/transform="1/' && refuse 'a transform has 12 numbers, not 11' bad.3mf
change 's/transform="0 1/transform="0 l/' && refuse "transform: 'l' is no number" bad.3mf
change '1a <!DOCTYPE model [<!ENTITY a "aaaa">]>' && refuse 'a document type' bad.3mf
change 's/<\/build>//' && refuse 'mismatched tag' bad.3mf
head -c 700 corner.3mf > cut.3mf
refuse 'cut.3mf: a ZIP archive that is damaged or ends too early' cut.3mf
python3 -c 'import zipfile; zipfile.ZipFile("other.zip", "w").writestr("word/document.xml", "<w/>")'
refuse 'other.zip: a ZIP archive without a 3MF model' other.zip
# The archive says of each entry whether it is encrypted: the first bit of its flags, which are 8 bytes into its record of the directory.
python3 -c '
data = bytearray(open("corner.3mf", "rb").read())
at = data.rindex(b"PK\1\2")
data[at + 8] |= 1
open("locked.3mf", "wb").write(data)'
"$HERE/../refuses" 'locked.3mf: 3D/3dmodel.model is encrypted' fettle-place locked.3mf -o x.stl

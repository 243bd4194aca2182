# E57 files that are damaged, cut or false are refused in one line that says where. Files by tests/write-e57, with bytes changed and checksums
# made right again.
refuse() { "$HERE/../refuses" "$@"; }
awk 'BEGIN { for (i = 0; i < 200; ++i) print i / 7, i / 11, 1, .5, 1, 2, 3, 0 }' > points.txt
"$HERE/../write-e57" good.e57 scaled points.txt
change() { # OUT PYTHON: changes `b`, the contents without checksums
    python3 - "$1" "$2" << 'P'
import runpy, struct, sys
def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8): crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF
raw = open("good.e57", "rb").read()
b = bytearray(b"".join(raw[i:i + 1020] for i in range(0, len(raw), 1024)))
def xml(old, new): # of the same length
    at = b.index(old); b[at:at + len(old)] = new + b" " * (len(old) - len(new))
exec(sys.argv[2])
b += bytes(-len(b) % 1020)
with open(sys.argv[1], "wb") as f:
    for i in range(0, len(b), 1020): f.write(b[i:i + 1020] + struct.pack(">I", crc32c(b[i:i + 1020])))
P
}
head -c 40 good.e57 > header.e57
refuse 'header.e57: E57 of 40 bytes' fettle-clean header.e57
head -c 2048 good.e57 > cut.e57
refuse 'cut.e57: E57 of 5120 bytes by its header, has 2048' fettle-clean cut.e57
(head -c 1500 good.e57; printf 'x'; tail -c +1502 good.e57) > damaged.e57
refuse 'damaged.e57: E57: wrong checksum of page 1: the file is damaged' fettle-clean damaged.e57
change version.e57 'b[8] = 2'
refuse 'version.e57: E57 of version 2' fettle-clean version.e57
change pages.e57 'b[40:48] = struct.pack("<Q", 512)'
refuse 'pages.e57: E57 with pages of 512 bytes' fettle-clean pages.e57
change xml.e57 'b[24:32] = struct.pack("<Q", 1 << 60)'
refuse 'xml.e57: E57: XML section at 1152921504606846976, which is no place in the file' fettle-clean xml.e57
change long.e57 'b[32:40] = struct.pack("<Q", 1 << 60)'
refuse 'long.e57: E57: XML section of 1152921504606846976 bytes' fettle-clean long.e57
change tags.e57 'xml(b"</e57Root>", b"</e57Boot>")'
refuse 'tags.e57: XML, line 2: mismatched tag' fettle-clean tags.e57
change root.e57 'xml(b"<e57Root ", b"<e58Root "); xml(b"</e57Root>", b"</e58Root>")'
refuse 'root.e57: E57: its XML has no e57Root' fettle-clean root.e57
change dtd.e57 'xml(b"<?xml version=\"1.0\" encoding=\"UTF-8\"?>", b"<!DOCTYPE e57Root>")'
refuse 'a document type' fettle-clean dtd.e57
change many.e57 'xml(b"recordCount=\"200\"", b"recordCount=\"999\"")'
refuse 'too few for 999 records' fettle-clean many.e57
change most.e57 'xml(b"recordCount=\"200\"><prototype", b"recordCount=\"9000000000000000000\"><prototype"[:27])'
refuse 'most.e57: ' fettle-clean most.e57
change few.e57 'xml(b"recordCount=\"200\"", b"recordCount=\"100\"")'
refuse 'bytes more than its records need' fettle-clean few.e57
change type.e57 'xml(b"type=\"ScaledInteger\"", b"type=\"String\"")'
refuse 'a column of type' fettle-clean type.e57
change range.e57 'xml(b"maximum=\"524287\"", b"maximum=\"10000\"")'
refuse 'exceeds its maximum' fettle-clean range.e57
change axes.e57 'xml(b"<cartesianX ", b"<cartesianU ")'
refuse 'neither Cartesian nor spherical' fettle-clean axes.e57
change packet.e57 'b[80] = 7'
refuse 'packet.e57: E57: a packet of type 7' fettle-clean packet.e57
change section.e57 'b[48] = 3'
refuse 'no section of points at 48' fettle-clean section.e57
change streams.e57 'b[84:86] = struct.pack("<H", 3)'
refuse 'a data packet of 3 columns, the scan has 8' fettle-clean streams.e57
refuse 'good.e57: units: the file says m, expected mm' fettle-clean good.e57 --file-units mm
# A scan without points has a section all the same, or none at all: some writers leave it out, and then say that it begins at 0.
change none.e57 'b[48] = 182; xml(b"recordCount=\"200\"", b"recordCount=\"0\"")'
refuse 'none.e57: E57: no section of points at 48' fettle-clean none.e57
change left-out.e57 'xml(b"fileOffset=\"48\" recordCount=\"200\"", b"fileOffset=\"0\" recordCount=\"0\"")'
fettle-clean left-out.e57 --report report.json > empty.pcd
jq -e '.points == 0' report.json > ok
change before.e57 'b[64:72] = struct.pack("<Q", 8)'
refuse 'before.e57: E57: data packets lie outside of their section' fettle-clean before.e57
change word.e57 'xml(b"maximum=\"524287\"", b"maximum=\"many\"")'
refuse "word.e57: XML, line 2: maximum: 'many' is not a number" fettle-clean word.e57
change half.e57 'xml(b"type=\"ScaledInteger\" minimum=\"-524288\"", b"type=\"Float\" precision=\"half\"")'
refuse "half.e57: XML, line 2: cartesianX: precision is 'half'" fettle-clean half.e57
"$HERE/../write-e57" stretched.e57 scaled pose=2,0,0,0,0,0,0 points.txt
refuse 'stretched.e57: XML, line 2: the rotation of a pose is no unit quaternion' fettle-clean stretched.e57
# A scan without points and colours takes nothing from the other, neither its colours nor its viewpoint.
"$HERE/../write-e57" good.e57 scaled pose=0.5,0.5,0.5,0.5,10,20,30 points.txt
fettle-clean good.e57 > alone.pcd
grep -aq '^VIEWPOINT 10 20 30 0.5 0.5 0.5 0.5$' alone.pcd
"$HERE/../write-e57" good.e57 scaled pose=0.5,0.5,0.5,0.5,10,20,30 points.txt points.txt
change empty-scan.e57 'import re; last = list(re.finditer(rb"fileOffset=.\d+. recordCount=.\d+.", b))[-1][0]; at = b.rindex(last)
red = b.rindex(b"<colorRed "); b[red + 1:red + 9] = b"colorOld"
new = b"fileOffset=\"0\" recordCount=\"0\""; b[at:at + len(last)] = new + b" " * (len(last) - len(new))'
fettle-clean empty-scan.e57 > beside.pcd
cmp alone.pcd beside.pcd

"""Where would a robot's controller bring its flange?  flange-check.py LANGUAGE PROGRAM URDF JOINTS

For each straight move of the program: its target, tool and base as the program sets them, against base to tool0 of the URDF at the joints
of that pose (a line of degrees each, the first pose left out). Exit 1 if they are more than 1 um or 0.001 degrees apart. It reads the
URDF and the languages by itself and knows nothing of the writer.
"""
import math
import re
import sys
import xml.etree.ElementTree

NUMBER = r"(-?[0-9.]+(?:[eE][-+]?[0-9]+)?)"


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse(a):
    r = [[a[j][i] for j in range(3)] for i in range(3)]
    return [r[i] + [-sum(r[i][k] * a[k][3] for k in range(3))] for i in range(3)] + [[0, 0, 0, 1]]


def frame(place, axis=(0, 0, 1), angle=0.0):
    """Turned about an axis by an angle in rad, then moved."""
    length = math.sqrt(sum(c * c for c in axis))
    x, y, z = (c / length for c in axis)
    c, s, v = math.cos(angle), math.sin(angle), 1 - math.cos(angle)
    return [[c + x * x * v, x * y * v - z * s, x * z * v + y * s, place[0]], [y * x * v + z * s, c + y * y * v, y * z * v - x * s, place[1]],
            [z * x * v - y * s, z * y * v + x * s, c + z * z * v, place[2]], [0, 0, 0, 1]]


def from_angles(place, about_z, about_y, about_x):
    none = (0, 0, 0)
    return product(product(frame(place, (0, 0, 1), about_z), frame(none, (0, 1, 0), about_y)), frame(none, (1, 0, 0), about_x))


def from_degrees(place, *angles):
    return from_angles(place, *(math.radians(a) for a in angles))


def from_quaternion(place, w, x, y, z):
    sine = math.sqrt(x * x + y * y + z * z)
    return frame(place, (x, y, z), 2 * math.atan2(sine, w)) if sine > 0 else frame(place)


def from_rotation_vector(place, v):
    angle = math.sqrt(sum(c * c for c in v))
    return frame(place, v, angle) if angle > 0 else frame(place)


def numbers(text):
    return [float(v) for v in text.split(",")]


def rapid(text):
    def pose(place, turn):
        return from_quaternion(numbers(place), *numbers(turn))

    targets = {name: pose(place, turn) for name, place, turn in re.findall(r"CONST robtarget (\w+) := \[\[([^]]*)\],\[([^]]*)\]", text)}
    tool = pose(*re.search(r"tooldata \w+ := \[TRUE,\[\[([^]]*)\],\[([^]]*)\]\]", text).groups())
    base = pose(*re.search(r"wobjdata \w+ := \[\w+,\w+,\"\w*\",\[\[([^]]*)\],\[([^]]*)\]\]", text).groups())
    return base, tool, [targets[n] for n in re.findall(r"MoveL (\w+),", text)]


def krl(text):
    def pose(words):
        v = {k: float(x) for k, x in re.findall(r"\b([XYZABC]) " + NUMBER, words)}
        return from_degrees([v["X"], v["Y"], v["Z"]], v["A"], v["B"], v["C"])

    base, tool = (pose(re.search(r"\$" + name + r"=\{([^}]*)\}", text)[1]) for name in ("BASE", "TOOL"))
    return base, tool, [pose(target) for target in re.findall(r"LIN \{E6POS: ([^}]*)\}", text)]


def fanuc(text):
    places = {}
    for number, body in re.findall(r"P\[(\d+)\]\{(.*?)\};", text, re.S):
        v = {k: float(x) for k, x in re.findall(r"\b([XYZWPR]) = " + NUMBER, body)}
        if "X" in v:
            places[number] = from_degrees([v["X"], v["Y"], v["Z"]], v["R"], v["P"], v["W"])
    x, y, z, r, p, w = (float(re.search("UTOOL 1: %s " % k + NUMBER, text)[1]) for k in "XYZRPW")
    return frame((0, 0, 0)), from_degrees([x, y, z], r, p, w), [places[n] for n in re.findall(r"^ *\d+:L P\[(\d+)\]", text, re.M)]


def urscript(text):
    def pose(words):
        v = numbers(words)
        return from_rotation_vector([1000 * c for c in v[:3]], v[3:])

    return frame((0, 0, 0)), pose(re.search(r"set_tcp\(p\[([^]]*)\]", text)[1]), [pose(p) for p in re.findall(r"movel\(p\[([^]]*)\]", text)]


class Urdf:
    def __init__(self, file):
        self.joints = {j.find("child").get("link"): j for j in xml.etree.ElementTree.parse(file).getroot().findall("joint")}

    def place(self, link, degrees):
        chain = []
        while link in self.joints:
            chain.insert(0, self.joints[link])
            link = chain[0].find("parent").get("link")
        values, pose = list(degrees), frame((0, 0, 0))
        for joint in chain:
            def of(tag, name):
                found = joint.find(tag)
                return [float(v) for v in ((found.get(name) if found is not None else None) or "0 0 0").split()]
            roll, pitch, yaw = of("origin", "rpy")
            pose = product(pose, from_angles([1000 * v for v in of("origin", "xyz")], yaw, pitch, roll))
            if joint.get("type") == "revolute":
                pose = product(pose, frame((0, 0, 0), of("axis", "xyz"), math.radians(values.pop(0))))
        return pose


language, program, urdf, joints = sys.argv[1:]
base, tool, targets = {"rapid": rapid, "krl": krl, "ls": fanuc, "urscript": urscript}[language]("".join(open(f).read() for f in program.split(",")))
robot = Urdf(urdf)
poses = [[float(v) for v in line.split()] for line in open(joints)][1:]
distance = turn = 0.0
for pose, target in zip(poses, targets, strict=True):
    wanted = product(inverse(robot.place("base", [])), robot.place("tool0", pose))
    off = product(inverse(wanted), product(product(base, target), inverse(tool)))
    distance = max(distance, math.sqrt(sum(off[i][3] ** 2 for i in range(3))))
    turn = max(turn, math.sqrt(sum((off[i][j] - (i == j)) ** 2 for i in range(3) for j in range(3)) / 2))
if not poses or distance > 1e-3 or math.degrees(turn) > 1e-3:
    sys.exit("%s: the flange is %g mm and %g degrees off" % (program, distance, math.degrees(turn)))

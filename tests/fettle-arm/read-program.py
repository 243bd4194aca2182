"""Reads a robot program back: read-program.py LANGUAGE PROGRAM [ROBOT-HEIGHT]  ->  x y z qw qx qy qz, a line for each target.

LANGUAGE is rapid, krl, ls or urscript. Positions in mm in the robot's base, orientations of the tool with its z towards
the holder, as paths have them. Written from the languages' manuals alone: it knows nothing of the writer.
"""
import math
import re
import sys

NUMBER = r"(-?[0-9.]+(?:[eE][-+]?[0-9]+)?)"


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def axis_turn(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]


def from_angles(about_z, about_y, about_x):
    return product(product(axis_turn("z", about_z), axis_turn("y", about_y)), axis_turn("x", about_x))


def from_quaternion(w, x, y, z):
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def from_rotation_vector(v):
    angle = math.sqrt(sum(c * c for c in v))
    if angle == 0:
        return [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    s = math.sin(angle / 2) / angle
    return from_quaternion(math.cos(angle / 2), *(c * s for c in v))


def to_quaternion(r):
    trace = r[0][0] + r[1][1] + r[2][2]
    squares = [1 + trace] + [1 + 2 * r[k][k] - trace for k in range(3)]
    if max(squares) == squares[0]:
        s = 2 * math.sqrt(squares[0])
        return [s / 4, (r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s]
    i = max(range(3), key=lambda k: r[k][k])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2 * math.sqrt(squares[i + 1])
    q = [(r[k][j] - r[j][k]) / s, 0, 0, 0]
    q[1 + i], q[1 + j], q[1 + k] = s / 4, (r[j][i] + r[i][j]) / s, (r[k][i] + r[i][k]) / s
    return q


def moved(frame, pose):
    """The pose in the frame that the given frame is in."""
    (p, r), (q, s) = frame, pose
    return [p[i] + sum(r[i][k] * q[k] for k in range(3)) for i in range(3)], product(r, s)


def rapid(text):
    targets = {}
    for name, place, turn in re.findall(r"CONST robtarget (\w+) := \[\[([^]]*)\],\[([^]]*)\]", text):
        targets[name] = [float(v) for v in place.split(",")], from_quaternion(*(float(v) for v in turn.split(",")))
    user = re.search(r"PERS wobjdata \w+ := \[\w+,\w+,\"\w*\",\[\[([^]]*)\],\[([^]]*)\]\]", text)
    frame = [float(v) for v in user[1].split(",")], from_quaternion(*(float(v) for v in user[2].split(",")))
    return [moved(frame, targets[n]) for n in re.findall(r"MoveL (\w+),", text)]


def krl_frame(text):
    values = {k: float(v) for k, v in re.findall(r"\b([XYZABC]) " + NUMBER, text)}
    return [values[k] for k in "XYZ"], from_angles(values["A"], values["B"], values["C"])


def krl(text):
    base = krl_frame(re.search(r"\$BASE=\{([^}]*)\}", text)[1])
    return [moved(base, krl_frame(target)) for target in re.findall(r"LIN \{E6POS: ([^}]*)\}", text)]


def fanuc(text, height):
    places = {}
    for number, body in re.findall(r"P\[(\d+)\]\{(.*?)\};", text, re.S):
        values = {k: float(v) for k, v in re.findall(r"\b([XYZWPR]) = " + NUMBER, body)}
        if "X" in values:
            places[number] = [values["X"], values["Y"], values["Z"] + height], from_angles(values["R"], values["P"], values["W"])
    return [places[n] for n in re.findall(r"^ *\d+:L P\[(\d+)\]", text, re.M)]


def urscript(text):
    poses = []
    for pose in re.findall(r"movel\(p\[([^]]*)\]", text):
        v = [float(c) for c in pose.split(",")]
        poses.append(([1000 * c for c in v[:3]], from_rotation_vector(v[3:])))
    return poses


language, file = sys.argv[1:3]
content = "".join(open(name).read() for name in file.split(","))
poses = {"rapid": rapid, "krl": krl, "urscript": urscript}[language](content) if language != "ls" else fanuc(content, float(sys.argv[3]))
for place, turn in poses:
    turn = product(turn, axis_turn("x", 180))  # z towards the holder
    print(" ".join("%.9f" % v for v in place + to_quaternion(turn)))

#!/usr/bin/env python3
"""Compares fettle-mill's reading of programs with that of LinuxCNC's interpreter, rs274.

    programs.py --made N --seed S       programs made of random lines
    programs.py FILE...                 programs of files

What fettle-mill accepts, rs274 must accept, and both must end at the same place after the same length and time of
feed moves. Prints the numbers of programs, and a line for each difference; status 1 if there is one.
"""
import argparse
import collections
import json
import math
import pathlib
import random
import re
import subprocess
import sys
import tempfile

MM_PER_INCH = 25.4
LAST_DIGIT = 1e-4  # of a coordinate that rs274 prints, in its unit
# Offsets that are not zero: what ignored them would end elsewhere.
TOOLS = "T1 P1 D0 Z12.5\nT2 P2 D0 Z31\n"
SYSTEM_2 = {5241: 100.0, 5242: -50.0, 5243: 7.0}  # parameters of G55's origin
AXES = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}  # first, second, and normal of each plane


class Motion:
    """Sums over the canonical commands that rs274 prints, mm and s."""

    def __init__(self):
        self.at = [0.0, 0.0, 0.0]
        self.unit, self.plane, self.feed = 1.0, AXES["XY"], 0.0
        self.length = self.time = self.rapid = self.length_error = self.time_error = 0.0

    def run(self, command, arguments):
        if command == "USE_LENGTH_UNITS":
            self.unit = MM_PER_INCH if "INCHES" in arguments else 1.0
        elif command == "SELECT_PLANE":
            self.plane = AXES[arguments[-2:]]
        elif command == "SET_FEED_RATE":
            self.feed = float(arguments) * self.unit / 60
        elif command == "STRAIGHT_TRAVERSE":
            self.rapid += self.straight_to(arguments)
        elif command == "STRAIGHT_FEED":
            self.add(self.straight_to(arguments), 4 * LAST_DIGIT)
        elif command == "ARC_FEED":
            self.add(self.arc_to([float(word) for word in arguments.split(",")]), 20 * LAST_DIGIT)

    def add(self, length, rounding):
        self.length += length
        self.length_error += rounding * self.unit
        if self.feed > 0:
            self.time += length / self.feed
            self.time_error += rounding * self.unit / self.feed

    def straight_to(self, arguments):
        to = [float(word) * self.unit for word in arguments.split(",")[:3]]
        length = math.dist(self.at, to)
        self.at = to
        return length

    def arc_to(self, words):
        first, second, normal = self.plane
        end, centre, turns = words[0:2], words[2:4], words[4]
        end, centre = [value * self.unit for value in end], [value * self.unit for value in centre]
        begin = math.atan2(self.at[second] - centre[1], self.at[first] - centre[0])
        angle = math.atan2(end[1] - centre[1], end[0] - centre[0]) - begin
        full = 2 * math.pi
        nothing = 2 * LAST_DIGIT * self.unit / max(math.dist(end, centre), LAST_DIGIT)  # rad: a full circle
        angle = angle % full if turns > 0 else -(-angle % full)
        if abs(angle) < nothing:
            angle += math.copysign(full, turns)
        radius = (math.dist((self.at[first], self.at[second]), centre) + math.dist(end, centre)) / 2
        rise = words[5] * self.unit - self.at[normal]
        self.at[first], self.at[second], self.at[normal] = *end, words[5] * self.unit
        return math.hypot(angle * radius, rise)


def read_by_rs274(folder, program):
    """The Motion of a program, or nothing if rs274 refuses it."""
    (folder / "tool.tbl").write_text(TOOLS)
    parameters = dict.fromkeys([*range(5161, 5170), *range(5181, 5190), 5210, *range(5211, 5220), 5220], 0.0)
    for system in range(9):
        parameters.update(dict.fromkeys(range(5221 + 20 * system, 5231 + 20 * system), 0.0))
    parameters[5220] = 1.0
    parameters.update(SYSTEM_2)
    (folder / "offsets.var").write_text("".join(f"{key}\t{value:.6f}\n" for key, value in sorted(parameters.items())))
    run = subprocess.run(["rs274", "-t", "tool.tbl", "-v", "offsets.var", "-g", str(program)], cwd=folder,
                         capture_output=True, text=True, errors="replace", timeout=60)
    motion = Motion()
    for command, arguments in re.findall(r"^\s*\d+ N[. \d]* (\w+)\((.*)\)$", run.stdout, re.MULTILINE):
        motion.run(command, arguments)
    no_end = "File ended with no percent sign or program end" in run.stdout + run.stderr  # fettle-mill needs none
    return motion if run.returncode == 0 or no_end else None


def read_by_fettle(folder, program, start):
    """The report and the last place, or fettle-mill's message."""
    command = ["fettle-mill", str(program), "--stock", "box:90000,90000,-1,90001,90001,0", "--cutter", "ball:1", "--step",
               "1", "-q", "-o", "part.stl", "--report", "report.json", "--trace", "trace.pcd", "--ascii"]
    run = subprocess.run(command + (["--start", "0,0,0"] if start else []), cwd=folder, capture_output=True, text=True,
                         timeout=60)
    if run.returncode == 2:
        return run.stderr.strip(), None
    report = json.loads((folder / "report.json").read_text())
    last = (folder / "trace.pcd").read_text().splitlines()[-1]
    return report, [float(word) for word in last.split()[:3]]


def difference(theirs, report, last, start):
    """What differs between rs274 and fettle-mill, in words; nothing if they agree."""
    if theirs is None:
        return "rs274 refuses it"
    float_error = 1e-6 * max(abs(value) for value in last)  # of the trace
    if max(abs(a - b) for a, b in zip(theirs.at, last)) > 0.6 * LAST_DIGIT * MM_PER_INCH + float_error:
        return f"ends at {last}, rs274 at {theirs.at}"
    if abs(report["feed_length"] - theirs.length) > theirs.length_error:
        return f"feeds {report['feed_length']} mm, rs274 {theirs.length}"
    if abs(report["feed_time"] - theirs.time) > theirs.time_error:
        return f"feeds {report['feed_time']} s, rs274 {theirs.time}"
    if start and abs(report["rapid_length"] - theirs.rapid) > theirs.length_error + 1e-3 * (1 + theirs.rapid):
        return f"rapid moves of {report['rapid_length']} mm, rs274 {theirs.rapid}"
    return None


class Maker:
    """Makes programs of random lines. Keeps track of the position so that most arcs fit."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.reset()

    def reset(self):
        self.at, self.inches, self.relative, self.plane, self.motion, self.fed = [0.0] * 3, False, False, "XY", None, False

    def number(self, value):
        text = f"{value:.4f}"
        if self.random.random() < 0.5:
            text = text.rstrip("0")
        if self.random.random() < 0.1:
            text = re.sub(r"^(-?)0\.(?=\d)", r"\1.", text)
        return ("+" if value > 0 and self.random.random() < 0.05 else "") + text

    def dress(self, words):
        """A line of the words in some order, spacing and case that mean the same."""
        self.random.shuffle(words)
        line = self.random.choice(["", " "]).join(words)
        if self.random.random() < 0.2:
            line = line.lower()
        if self.random.random() < 0.1:
            line = f"N{self.random.randrange(99999)} " + line
        if self.random.random() < 0.1:
            line += self.random.choice([" (a comment)", " ; another", "(G1 X7)"])
        return line

    def coordinate(self, axis, target):
        return self.number(target - self.at[axis] if self.relative else target)

    def mode_words(self):
        """Words that LinuxCNC executes before the motion of their line."""
        words, choose = [], self.random.random
        if choose() < 0.06:
            self.plane = self.random.choice(list(AXES))
            words.append({"XY": "G17", "XZ": "G18", "YZ": "G19"}[self.plane])
        if choose() < 0.06:
            self.relative = not self.relative
            words.append("G91" if self.relative else "G90")
        if choose() < 0.06:
            inches = self.random.random() < 0.5
            factor = (MM_PER_INCH if self.inches else 1) / (MM_PER_INCH if inches else 1)
            self.at = [value * factor for value in self.at]
            self.inches = inches
            words.append("G20" if inches else "g21")
        for word in ("S500", "M3", "M8", "G61", "G64", "G94", "G40", "G80"):
            if choose() < 0.03 and not (word == "G80" and self.motion is None):
                words.append(word)
                if word == "G80":
                    self.motion = None
                if word == "G94":  # LinuxCNC forgets the feed
                    self.fed = False
        if choose() < (0.15 if self.fed else 1):
            self.fed = True
            words.append("F" + self.number(self.random.uniform(1, 2000)))
        return words

    def straight(self):
        words = self.mode_words()
        motion = self.random.choice("011")
        if motion != self.motion or self.random.random() < 0.3:
            words.append(f"G{motion}")
        self.motion = motion
        axes = self.random.sample(range(3), self.random.randint(1, 3))
        size = 4 if self.inches else 100
        for axis in axes:
            target = round(self.random.uniform(-size, size), 4) if not self.relative else self.at[axis] + round(
                self.random.uniform(-size, size), 4)
            words.append("XYZ"[axis] + self.coordinate(axis, target))
            self.at[axis] = target
        return self.dress(words)

    def arc(self):
        words = self.mode_words()
        motion = self.random.choice("23")
        words.append(f"G{motion}")
        self.motion = motion
        first, second, normal = AXES[self.plane]
        size = 2 if self.inches else 50
        radius, begin = self.random.uniform(size / 20, size), self.random.uniform(0, 2 * math.pi)
        turn = self.random.choice([2 * math.pi, self.random.uniform(0.1, 6.1)])
        offset = [round(-radius * math.cos(begin), 4), round(-radius * math.sin(begin), 4)]
        angle = math.atan2(-offset[1], -offset[0]) + (turn if motion == "3" else -turn)
        radius = math.hypot(*offset)
        centre = [self.at[first] + offset[0], self.at[second] + offset[1]]
        to = [round(centre[0] + radius * math.cos(angle), 4), round(centre[1] + radius * math.sin(angle), 4)]
        if turn < 6.2:
            words += ["XYZ"[axis] + self.coordinate(axis, value) for axis, value in ((first, to[0]), (second, to[1]))]
        if self.random.random() < 0.3:
            height = round(self.at[normal] + self.random.uniform(-size, size), 4)
            words.append("XYZ"[normal] + self.coordinate(normal, height))
            self.at[normal] = height
        # Nearly half a turn by R: the rounding of the ends moves the centre far.
        if turn < 6.2 and abs(turn - math.pi) > 0.3 and self.random.random() < 0.3:
            words.append("R" + self.number(radius if turn < math.pi else -radius))
        else:
            words += ["IJK"[first] + self.number(offset[0]), "IJK"[second] + self.number(offset[1])]
        if turn < 6.2:
            self.at[first], self.at[second] = to
        return self.dress(words)

    def oddity(self):
        """A line that fettle-mill must refuse, or read as rs274 does."""
        return self.random.choice([
            "X--1", "G1 G0 X1", "G55 G1 X1", "G54", "G43 H1", "G43 H2 Z1", "G49", "#1=3", "X[1+2]", "X#1", "/G1 X1", "G2 X1",
            "G4 P0.1", "G4 X1", "M98", "o1 sub", "N1.5 G0 X1", "G20 F10 G1 X1", "G21 F10 X1", "G10 L2 P1 X5", "G53 G0 X1",
            "G92 X0", "G28", "G90.1", "G91.1", "G98", "G99", "M0", "M1", "T2 M6", "X1 X2", "F0", "F-1", "H1", "P1",
            "G81 X1 Z-1 R1", "G80", "G93", "G94", "G64 P0.01", "G64 P2 G2 X1 I0.5",  "G80 G0 X1", "G80 G1 Y2 F5", "G41", "%", "(", "x1y1", "G 1 X 1 0", "g5 x1", "G38.2 Z0",
            "M2", "U1", "A1", "G1.5", "G61.1", "G64 Q0.1 P0.1", "M48", "M60", "X+-1", "X1e2", "X.", "Y", "G17.1", "G0 R1", "G1 I1"])

    def program(self):
        """The text of a program, and whether it needs --start."""
        self.reset()
        start = self.random.random() < 0.5
        lines = [self.random.choice(["", "(made)", "G17 G21 G40 G49 G80 G90 G00", "G17 G20 G40 G49 G80 G90 G00"])]
        self.inches = "G20" in lines[0]
        if "G00" in lines[0]:
            self.motion = "0"
        if not start:
            if self.random.random() < 0.3:
                lines.append(self.random.choice(["T1 M6 G43 H1", "G55", "G54"]))
            lines.append("G0 X0 Y0 Z0")
            self.motion = "0"
        for _ in range(self.random.randint(3, 30)):
            lines.append(self.straight() if self.random.random() < 0.6 else self.arc())
        for _ in range(self.random.choice([0, 0, 0, 1, 2])):
            lines.insert(self.random.randint(1, len(lines)), self.oddity())
        if self.random.random() < 0.2:
            return "\n".join(["%", *lines, "%"]) + "\n", start
        return "\n".join([*lines, self.random.choice(["M2", "M30", "m02"])]) + "\n", start


def compare(folder, name, program, start, counts):
    message, last = read_by_fettle(folder, program, start)
    if last is None:
        # One message stands for all with other numbers.
        what = re.sub(r"^fettle-mill: \S+: (line \d+: )?", "", message)
        what = re.sub(r"(?<=got )'[^']*'", "…", what)
        counts["refused: " + (what if what.endswith("not accepted") else re.sub(r"[-+]?\d+(\.\d+)?", "N", what))[:90]] += 1
        return
    counts["accepted"] += 1
    what = difference(read_by_rs274(folder, program), message, last, start)
    if what:
        counts["different"] += 1
        print(f"{name}: {what}")
        if counts["different"] == 1:
            (pathlib.Path.cwd() / "different.ngc").write_bytes(program.read_bytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--made", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("files", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    counts = collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        maker = Maker(options.seed)
        for index in range(options.made):
            text, start = maker.program()
            program = folder / "made.ngc"
            program.write_text(text)
            compare(folder, f"program {index} of seed {options.seed}", program, start, counts)
        for file in options.files:
            compare(folder, file.name, file.resolve(), True, counts)
    for key, count in counts.most_common():
        print(f"{count:5} {key}")
    return 1 if counts["different"] > 0 else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""The same work in millimetres, inches and metres: every number of every report and every field is the one in millimetres, times the
units of its dimension. Where a job is, its units are mm and N, or in and lbf; elsewhere the files are in mm, in or m.

A key that no line of DIMENSIONS names has no dimension: a new one that has is found, because it differs by 25 times or more."""
import collections
import fnmatch
import json
import math
import os
import re
import shutil
import struct
import subprocess
import sys

MM = {"mm": 1.0, "in": 25.4, "m": 1000.0}
NEWTON = {"N": 1.0, "lbf": 4.4482216152605}

# What a key measures, where it has a dimension: exponents of length and force. A key is "TOOL PATH", the path of a member of a report or a
# document, or the name of a field; rows of nested arrays have their columns as the last part. The first pattern that matches counts.
DIMENSIONS = [
    ((0, 0), """* u, * v"""),  # parameters, which no tool converts (docs/conventions.md)
    ((0, 0), """surfel *, path *, assess *, finish *, mill *, verify *"""),  # these write mm, whatever the unit of what they read
    ((0, 0), """* checked, * joints.*_at, align degrees_of_freedom.shift"""),
    ((0, 1), """*force, *force.min, *force.max, *force.down"""),
    ((-1, 1), """*force.stiffness"""),
    ((-2, 1), """*pressure"""),
    ((-1, 0), """*.curvature, *.shape.form"""),
    ((3, -1), """*removal.coefficient"""),
    ((3, 0), """*volume"""),
    ((2, 0), """*area"""),
    ((1, 0), """* x, * y, * z, * error, * sigma, * removed, * displacement, * radius, * gap, * indentation, * deepest"""),
    ((1, 0), """* clearance*, *.clearance, * foot_?, * joint7, * min, * min_between, * tolerance, * max_missed_depth, * beyond"""),
    ((1, 0), """* mean, * mean_abs, * rms, * sd, * min, * max, * band, * p??, * median, * misfit, * max_distance, * worst"""),
    ((1, 0), """*regions.*.mean, *regions.*.mean_abs, *regions.*.rms, *regions.*.sd, *regions.*.min, *regions.*.max"""),
    ((1, 0), """*regions.*.band, *regions.*.p??, *_at, *histogram.limit, *weld_tolerance, *reference_sigma"""),
    ((1, 0), """*touches.[012], *touch_sigma, *fit.rms, fit max_abs, * predicted_band*, *.predicted_band*, *shift, *shape.point"""),
    ((1, 0), """*shape.scale, *shape.coefficients, *path_length, *layer_thickness, *layer_distance, *layers.thickness"""),
    ((1, 0), """*layers.distance, *step_over, *covering_length, * start, * step, *passes.from, *passes.to, *wheel_radius"""),
    ((1, 0), """*job.anomaly.*, *job.sampling.*, *probe.accuracy, *job.tolerance, *safe_height, *wheel.*, *feed.rate"""),
    ((1, 0), """form *least_squares, form *minimum_zone, form *.width, form *.centre, form *.radius, form *.point"""),
    ((1, 0), """form *.peak, form *.valley, form *.rms, form *.contacts.*, form *offset"""),
    ((1, 0), """contact cell, * track.value"""),
    ((1, 0), """find anomalies.height, find height, find noise, merge disagreement, merge pairs.rms, merge scans.centre"""),
    ((1, 0), """merge scans.noise, merge *.sd_shift, merge spacing, reconstruct max_gap, step *deviation"""),
    ((1, 0), """station *anomaly.?, station *sampling.?, station settings.*"""),
    ((1, 0), """align centre, align next.*, align sd.[xyz], align degrees_of_freedom.sd"""),
]
# Numbers without one dimension: products of a surface's parameters; the last column of a rigid motion, which ends in 1.
MIXED = ["covariance", "surface.covariance", "alternatives.covariance", "surface.alternatives.covariance", "transform.3", "next.transform.3"]
MIXED += ["scans.matrix.3", "scans.covariance.0", "scans.covariance.1", "scans.covariance.2"]
MIXED += ["joints.min", "joints.max"]  # degrees, and the track's lengths
MIXED += ["min.pose", "min.point", "min_between.pose", "min_between.point", "joints.max_acceleration_at"]  # which one it is of several that are equal

COUNT_TOLERANCE = 1e-3  # of the cubes of merged scans: where rounding moves a lone point to the next one
TOLERANCE = 0.05  # wrong units are off by 4 times at least; grinding step by step amplifies the rounding of coordinates
FLOOR = 1e-5  # mm, N and their products: below it, numbers are rounding


def dimension_of(tool, key):
    name = f"{tool} {key}"
    for dimension, patterns in DIMENSIONS:
        if any(fnmatch.fnmatchcase(name, pattern.strip()) for pattern in patterns.split(",")):
            return dimension
    return 0, 0


def leaves(tree, path=""):
    """Numbers of a JSON document by their path, arrays without indices."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from leaves(value, f"{path}.{key}" if path else key)
    elif isinstance(tree, list):
        for element in tree:
            for column, value in enumerate(element) if isinstance(element, list) else [(None, element)]:
                yield from leaves(value, path if column is None else f"{path}.{column}")
    elif isinstance(tree, (int, float)) and not isinstance(tree, bool):
        yield path, float(tree)
    else:
        yield path, str(tree)


def read_pcd(path):
    """Header lines, names of the fields, rows of numbers."""
    with open(path, "rb") as file:
        head, form, body = re.split(rb"DATA (\w+)\n", file.read(), maxsplit=1)
    header = head.decode().splitlines()
    entries = {line.split()[0]: line.split()[1:] for line in header}
    if form == b"ascii":
        return header, entries["FIELDS"], [tuple(map(float, row.split())) for row in body.decode().splitlines()]
    code = {"F4": "f", "F8": "d", "I4": "i", "U4": "I", "I2": "h", "U2": "H", "I1": "b", "U1": "B"}
    layout = "<" + "".join(n + code[t + s] for t, s, n in zip(entries["TYPE"], entries["SIZE"], entries["COUNT"]))
    return header, entries["FIELDS"], list(struct.iter_unpack(layout, body))


def fields(path):
    """Numbers of a PCD by their field."""
    _, names, rows = read_pcd(path)
    for row in rows:
        yield from zip(names, map(float, row))


def convert(path, to, unit):
    """Writes a PCD in mm as an ASCII one in another unit."""
    header, names, rows = read_pcd(path)
    powers = [dimension_of("belt", name)[0] for name in names]
    with open(to, "w") as file:
        print(*(line.replace("# units mm", f"# units {unit}") for line in header), "DATA ascii", sep="\n", file=file)
        for row in rows:
            print(*(repr(value / MM[unit] ** power) for value, power in zip(row, powers)), file=file)


def scaled(tree, keys, factor, is_length=False):
    """A JSON document with the numbers under some keys multiplied."""
    if isinstance(tree, dict):
        return {key: scaled(value, keys, factor, key in keys) for key, value in tree.items()}
    if isinstance(tree, list):
        return [scaled(value, keys, factor, is_length) for value in tree]
    return tree * factor if is_length and not isinstance(tree, str) else tree


class Work:
    """Runs tools in one system of units and keeps every number that they write."""

    def __init__(self, length, force="N"):
        self.length, self.force = length, force
        self.mm, self.newton = 1 / MM[length], 1 / NEWTON[force]
        self.units = {"length": length, "force": force}
        self.numbers = []  # (tool, key, value)

    def write(self, path, document):
        with open(path, "w") as file:
            json.dump(document, file)
        return path

    def tool(self, name, *words, out):
        """@param words  numbers are lengths in mm"""
        words = [repr(word * self.mm) if isinstance(word, float) else word for word in words]
        command = [f"fettle-{name}", *words, "-q", "--report", "report.json", "-o", out]
        ended = subprocess.run(command, capture_output=True, text=True)
        if ended.returncode not in (0, 1):
            sys.exit(f"{' '.join(command)}\n{ended.stderr}")
        for path in "report.json", out:
            if path.endswith(".json"):
                with open(path) as file:
                    self.add(name, leaves(json.load(file)))
        if out.endswith(".pcd"):
            self.add(name, fields(out))

    def add(self, name, numbers):
        self.numbers += [(name, key, value) for key, value in numbers]

    def job(self):
        mm, newton = self.mm, self.newton

        def ring(half):
            return [[x * half * mm, y * half * mm] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]

        return {
            "kind": "job", "units": self.units, "surface": {"type": "freeform"},
            "anomaly": ring(8), "sampling": ring(18),
            "probe": {"accuracy": 0.05 * mm, "tip_radius": 0}, "tolerance": 0.3 * mm, "safe_height": 40 * mm,
            "wheel": {"radius": 25 * mm, "width": 6 * mm, "min_radius": 15 * mm},
            "force": {"min": 20 * newton, "down": 40 * newton, "max": 60 * newton, "stiffness": 40 * newton / mm},
            "feed": {"axis": "y", "rate": 25 * mm, "step_over": 5 * mm},
            "removal": {"coefficient": 10 * mm**3 / newton},
        }

    def part(self):
        mm = self.mm
        return {
            "kind": "part", "units": {"length": self.length}, "step": 1.9 * mm,
            "surface": {"type": "sphere", "centre": [0, 0, -190 * mm], "radius": 200 * mm},
            "region": {"x": [-22 * mm, 22 * mm], "y": [-22 * mm, 22 * mm]}, "noise": f"normal:{0.02 * mm!r}",
            "anomalies": [{"type": "hill", "centre": [0, 0], "semi_axes": [6 * mm, 5 * mm], "height": 2 * mm}],
        }

    def wheel(self):
        mm = self.mm
        return {
            "kind": "wheel", "units": {"length": self.length, "stress": "MPa"}, "radius": 50 * mm, "width": 20 * mm,
            "layer": {"thickness": 10 * mm, "young": 3.0, "poisson": 0.45}, "belt_speed": 15000 * mm,
            "law": {"type": "preston", "coefficient": 3e-5},
        }


def make_parts(work):
    work.write("part.json", work.part())
    work.tool("part", "part.json", out="part.stl")
    work.tool("part", "part.json", "--without-anomaly", out="truth.stl")
    work.tool("part", "part.json", "--cloud", out="part.pcd")


def casting(work):
    """From touches to the ground part."""
    make_parts(work)
    work.write("job.json", work.job())
    work.tool("sample", "job.json", "--on", "part.stl", "--noise", f"normal:{0.05 * work.mm!r}", out="samples.pcd")
    work.tool("estimate", "job.json", "samples.pcd", out="estimated.pcd")
    work.tool("fit", "job.json", "estimated.pcd", out="fit.json")
    work.tool("margin", "job.json", "fit.json", out="surface.json")
    work.tool("mesh", "surface.json", "--step", 4.0, "--within", "job.json", "--sigma", out="mesh.pcd")
    work.tool("plan", "job.json", "surface.json", out="plan.json")
    work.tool("grind", "plan.json", "--stock", "part.stl", "--gantry", "virtual", "--cell", 0.5, out="ground.pcd")
    work.tool("compare", "ground.pcd", "--to", "truth.stl", "--within", "job.json", out="errors.pcd")
    work.tool("form", "sphericity", "--within", "job.json", "ground.pcd", out="form.json")
    work.tool("render", "errors.pcd", "--within", "job.json", out="errors.png")


def scans(work):
    """Files in a unit of their own, without a job."""
    unit = work.length
    make_parts(work)
    for a, b in ("part.pcd", "truth.stl"), ("part.stl", "truth.stl"):
        work.tool("compare", a, "--to", b, "--file-units", unit, "--to-units", unit, "--units", unit, "--tolerance", 0.5, out="errors.pcd")
    work.tool("align", "part.pcd", "--to", "truth.stl", "--near", "--file-units", unit, "--to-units", unit, out="aligned.pcd")
    work.tool("form", "sphericity", "--file-units", unit, "--units", unit, "part.pcd", out="form.json")
    work.tool("form", "straightness", "--sections", 10.0, "--file-units", unit, "--units", unit, "part.pcd", out="form.json")


def belt(work):
    """Surfels are made in mm; from there on in a unit of their own."""
    make_parts(work)
    work.write("wheel.json", work.wheel())
    unit = work.length
    work.tool("surfel", "truth.stl", "--stock", "part.stl", "--file-units", unit, "--stock-units", unit, "--spacing", "1.5", out="mm.pcd")
    work.tool("path", "mm.pcd", "--step-over", "6", "--spacing", "4", out="rows.pcd")
    convert("mm.pcd", "work.pcd", unit)
    convert("rows.pcd", "path.pcd", unit)
    wheel = ["--wheel", "wheel.json", "--force", "20", "--cells", "16"]
    work.tool("contact", "work.pcd", *wheel, "--at", f"0,0,{10 * work.mm!r},1,0,0,0", out="contact.pcd")
    work.tool("belt", "work.pcd", "--path", "path.pcd", *wheel, "--trace", "trace.pcd", out="ground.pcd")
    work.add("trace", fields("trace.pcd"))
    work.tool("assess", "work.pcd", "--lower", "-0.1", "--upper", "0.1", out="assessed.pcd")


def robot(work):
    """Joints and clearances of an arm along a path."""
    samples = os.environ["SAMPLES"]
    convert(f"{samples}/paths/keel.pcd", "path.pcd", work.length)
    with open(f"{samples}/robots/irb1400.json") as file:
        document = json.load(file)
    document["units"]["length"] = work.length
    lengths = {"a", "d", "min", "max", "max_speed", "from", "to", "radius", "radius_from", "radius_to", "centre", "size", "position", "distance"}
    work.write("robot.json", scaled(document, lengths | {"calibration_error"}, work.mm))
    work.tool("arm", "robot.json", "--inverse", "--feed", 50.0, "path.pcd", out="joints.pcd")
    work.tool("arm", "robot.json", "--forward", "joints.pcd", out="poses.pcd")
    work.tool("collide", "robot.json", "path.pcd", out="checked.pcd")


def raw(work):
    """From scans to the anomaly; a design, where fettle-step is built."""
    samples = os.environ["SAMPLES"]
    make_parts(work)
    unit = work.length
    with open("identity.txt", "w") as file:
        file.write("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
    box = ",".join(repr(edge * work.mm) for edge in (-20, -20, -10, 20, 20, 15))
    for filters in (["--outliers", f"radius:{4 * work.mm!r},3"], ["--outliers", "statistical:8,3", "--thin", 2.0]):
        work.tool("clean", "part.pcd", "--crop", f"box:{box}", *filters, out="clean.pcd")
    work.tool("place", "part.stl", "--up", "plane", "--threshold", 2.0, "--centre", "--file-units", unit, out="placed.ply")
    work.tool("place", "part.pcd", "--turn", "x,30", "--centre", out="turned.pcd")
    work.tool("reconstruct", "part.pcd", "--max-gap", 6.0, "--from", f"0,0,{300 * work.mm!r}", out="built.stl")
    work.tool("reconstruct", "clean.pcd", "--facing", "0,0,1", out="built.stl")
    work.tool("find", "part.stl", "--file-units", unit, "--units", unit, "--max-width", 20.0, "--min-height", 0.5, out="found.pcd")
    work.tool("find", "part.pcd", "--against", "truth.stl", "--against-units", unit, "--units", unit, "--transform-in", "identity.txt", out="found.pcd")
    for view in "2", "3":
        work.tool("place", f"{samples}/scans/views/{view}.pcd", "--units", unit, out=f"{view}.pcd")
    work.tool("merge", "2.pcd", "3.pcd", out="merged.pcd")
    work.tool("view", "found.pcd", out="page.html")
    if shutil.which("fettle-step"):
        work.tool("step", f"{samples}/designs/clamp.step", "--units", unit, "--tolerance", 0.5, out="design.stl")


def session(work):
    """An operator's session from the first touch to the ground part."""
    make_parts(work)
    work.write("job.json", work.job())
    with open("operator.txt", "w") as file:
        file.write("0 next\n0 next\n0 start\n0 start\n")
    shutil.rmtree("session", ignore_errors=True)
    command = ["fettle-station", "job.json", "--gantry", "virtual", "--stock", "part.stl", "--cell", repr(0.5 * work.mm), "--steer", "operator.txt"]
    ended = subprocess.run([*command, "--session", "session", "--report", "report.json", "-q"], capture_output=True, text=True)
    if ended.returncode not in (0, 1):
        sys.exit(f"{' '.join(command)}\n{ended.stderr}")
    for path in ["report.json", *sorted(os.path.join("session", name) for name in os.listdir("session"))]:
        if path.endswith(".json"):
            with open(path) as file:
                work.add("station", leaves(json.load(file)))
        elif path.endswith(".pcd"):
            work.add("station", fields(path))


def sizes(work):
    """Root mean square of the numbers that a tool wrote under a key, and how many there are."""
    squares, counts = collections.Counter(), collections.Counter()
    for tool, key, value in work.numbers:
        counts[tool, key] += 1
        if isinstance(value, float) and math.isfinite(value):
            squares[tool, key] += value**2
    return {name: (math.sqrt(squares[name] / counts[name]), counts[name]) for name in counts}


def compared(base, other):
    """Complaints about what was written in some units, against what was in millimetres."""
    in_mm, found = sizes(base), sizes(other)
    for tool, key in sorted(in_mm.keys() | found.keys()):
        size_mm, count_mm = in_mm.get((tool, key), (0, 0))
        size, count = found.get((tool, key), (0, 0))
        length, force = dimension_of(tool, key)
        converted = size / (other.mm**length * other.newton**force)
        if abs(count - count_mm) > (COUNT_TOLERANCE * count_mm if tool == "merge" else 0):
            yield f"{other.length}: fettle-{tool} {key}: {count} values, {count_mm} in mm"
        elif key not in MIXED and not abs(converted - size_mm) <= max(TOLERANCE * size_mm, FLOOR):
            yield f"{other.length}: fettle-{tool} {key}: root mean square {size:.6g}, in mm {size_mm:.6g}"


def main():
    complaints = []
    for chain, systems in (
        (casting, [("mm", "N"), ("in", "lbf")]),
        (scans, [("mm", "N"), ("in", "N"), ("m", "N")]),
        (belt, [("mm", "N"), ("in", "N"), ("m", "N")]),
        (raw, [("mm", "N"), ("in", "N"), ("m", "N")]),
        (session, [("mm", "N"), ("in", "lbf")]),
        (robot, [("mm", "N"), ("in", "N"), ("m", "N")]),
    ):
        runs = [Work(*system) for system in systems]
        for work in runs:
            chain(work)
        for work in runs[1:]:
            complaints += [f"{chain.__name__}, {complaint}" for complaint in compared(runs[0], work)]
    print(*complaints, sep="\n")
    sys.exit(bool(complaints))


if __name__ == "__main__":
    main()

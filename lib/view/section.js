// Sections: the plane through a line on the screen that looks along the view. The profile is drawn over the distance along the
// line; the height is that towards the eye, z when one looks from above.

// @return { origin, direction, up, normal, length }, or null for a line that is a point
function sectionPlane(camera, from, to) {
    const a = camera.unproject(from[0], from[1], 0), b = camera.unproject(to[0], to[1], 0);
    const length = Math.hypot(...subtract(b, a));
    if (!(length > 2 * camera.scale)) return null;
    const direction = subtract(b, a).map(d => d / length);
    return { origin: a, direction, up: camera.eye, normal: cross(direction, camera.eye), length };
}

function inPlane(plane, p) {
    return [dot(subtract(p, plane.origin), plane.direction), dot(p, plane.up)];
}

// Points no farther from the plane than half a cell, as pieces of lines through neighbours. Where the error and the normal of the
// reference are known, the reference's profile is test - error * normal.
function cloudProfile(layer, field, plane) {
    const halfWidth = 0.75 * layer.spacing, found = [];
    const n = plane.normal, start = dot(subtract(layer.origin, plane.origin), n), step = layer.step.map((s, k) => s * n[k]), p = layer.position;
    for (let i = 0, at = 0; i < layer.count; ++i, at += 3) {
        const off = start + step[0] * p[at] + step[1] * p[at + 1] + step[2] * p[at + 2];
        if (off > halfWidth || off < -halfWidth) continue;
        const point = pointOf(layer, i), [s, h] = inPlane(plane, point);
        if (s < 0 || s > plane.length) continue;
        const error = field.name === "error" && layer.normal ? fieldValue(field, i) : NaN;
        found.push({ s, h, reference: Number.isFinite(error) ? inPlane(plane, along(point, -error * field.lengthUnit, normalOf(layer, i))) : null });
    }
    found.sort((a, b) => a.s - b.s);
    const test = chain(found.map(f => [f.s, f.h]), 4 * layer.spacing);
    const reference = chain(found.filter(f => f.reference).map(f => f.reference), 4 * layer.spacing);
    return { test, reference };
}

// Pieces of points that follow each other no farther apart than `gap`.
function chain(points, gap) {
    const pieces = [];
    points.forEach((p, i) => {
        const before = points[i - 1];
        if (before && Math.hypot(p[0] - before[0], p[1] - before[1]) <= gap) pieces[pieces.length - 1].push(p);
        else pieces.push([p]);
    });
    return pieces;
}

// Where the triangles cross the plane.
function meshProfile(layer, plane) {
    const pieces = [], corners = layer.corners, off = new Float64Array(layer.count);
    for (let i = 0; i < layer.count; ++i) off[i] = dot(subtract(pointOf(layer, i), plane.origin), plane.normal);
    for (let t = 0; t < corners.length; t += 3) {
        const ends = [];
        for (let k = 0; k < 3; ++k) {
            const a = corners[t + k], b = corners[t + (k + 1) % 3];
            if (off[a] > 0 === off[b] > 0) continue;
            const p = pointOf(layer, a), q = pointOf(layer, b);
            ends.push(inPlane(plane, along(p, off[a] / (off[a] - off[b]), subtract(q, p))));
        }
        if (ends.length === 2 && ends.some(([s]) => s >= 0 && s <= plane.length)) pieces.push(ends);
    }
    return pieces;
}

// Curves of all layers that are decoded: { name, colour, width, pieces }.
function profileCurves(layers, current, field, plane) {
    const curves = [], colours = ["#009e73", "#e69f00", "#cc79a7", "#56b4e9"];
    for (const layer of layers) {
        if (!layer.position || layer === current) continue;
        const pieces = layer.triangles > 0 ? meshProfile(layer, plane) : cloudProfile(layer, { name: "" }, plane).test;
        curves.push({ name: layer.name, colour: colours[curves.length % colours.length], width: 1.2, pieces });
    }
    if (current.triangles > 0) {
        curves.push({ name: current.name, colour: kInk, width: 2, pieces: meshProfile(current, plane) });
    } else {
        const { test, reference } = cloudProfile(current, field, plane);
        if (reference.length > 0) curves.push({ name: "reference", colour: "#d55e00", width: 1.5, pieces: reference });
        curves.push({ name: reference.length > 0 ? "test" : current.name, colour: cssColour(kTouchInk), width: 2, pieces: test });
    }
    return curves.filter(curve => curve.pieces.length > 0);
}

function drawTicks(context, span, count, place) {
    const step = roundDown((span[1] - span[0]) / count) || 1;
    for (let k = Math.ceil(span[0] / step); k * step <= span[1]; ++k) place(k * step, short(Number((k * step).toPrecision(6))));
}

// @param width, height  of the canvas, pixels
function drawProfile(context, width, height, plane, curves, unit) {
    context.fillStyle = "#ffffff";
    context.fillRect(0, 0, width, height);
    const box = { left: 62, right: width - 14, top: 26, bottom: height - 34 };
    let low = Infinity, high = -Infinity;
    for (const { pieces } of curves)
        for (const piece of pieces)
            for (const [s, h] of piece)
                if (s >= 0 && s <= plane.length) [low, high] = [Math.min(low, h), Math.max(high, h)];
    if (!(low <= high)) {
        drawText(context, "The line does not cross the part.", box.left, height / 2);
        return;
    }
    const margin = 0.06 * (high - low) || 0.01 * plane.length;
    [low, high] = [low - margin, high + margin];
    const x = s => box.left + s / plane.length * (box.right - box.left), y = h => box.bottom - (h - low) / (high - low) * (box.bottom - box.top);
    context.strokeStyle = "#d9dfe5";
    context.lineWidth = 1;
    drawTicks(context, [0, plane.length], 8, (s, text) => {
        context.strokeRect(x(s), box.top, 0, box.bottom - box.top);
        drawText(context, text, x(s), box.bottom + 11, { align: "center", colour: kSoft });
    });
    drawTicks(context, [low, high], 4, (h, text) => {
        context.strokeRect(box.left, y(h), box.right - box.left, 0);
        drawText(context, text, box.left - 6, y(h), { align: "right", colour: kSoft });
    });
    context.save();
    context.beginPath();
    context.rect(box.left, box.top, box.right - box.left, box.bottom - box.top);
    context.clip();
    for (const { pieces, colour, width: line } of curves) {
        context.strokeStyle = context.fillStyle = colour;
        context.lineWidth = line;
        context.beginPath();
        for (const piece of pieces) {
            if (piece.length === 1) context.fillRect(x(piece[0][0]) - 1, y(piece[0][1]) - 1, 2, 2);
            piece.forEach(([s, h], i) => i === 0 ? context.moveTo(x(s), y(h)) : context.lineTo(x(s), y(h)));
        }
        context.stroke();
    }
    context.restore();
    let at = box.left;
    for (const { name, colour } of curves) {
        context.fillStyle = colour;
        context.fillRect(at, 11, 14, 3);
        drawText(context, name, at + 19, 12);
        at += 19 + context.measureText(name).width + 18;
    }
    const times = (box.bottom - box.top) / (high - low) / ((box.right - box.left) / plane.length);
    drawText(context, `along the section, ${unit}; heights \u00d7 ${short(Number(times.toPrecision(2)))}`, box.right, height - 8, { align: "right", colour: kSoft });
}

// What is drawn over the part on a canvas of its own: legend, axes, scale bar, extremes, picks, the line of a section.

const kInk = "#282828", kSoft = "#5a6672", kPaper = "rgba(255, 255, 255, 0.86)";
const kFewPoints = 100;        // so few are drawn as dots
const kNarrow = 600;           // pixels; a window below it has a small legend
const kAxesHeight = 120;      // pixels, of the canvas with the axes and the scale bar
const kLegendWidth = 158, kNarrowLegendWidth = 92;
const kNoColours = new Uint8Array([128, 128, 128]);
const kUndefinedColour = [128 / 255, 128 / 255, 128 / 255];
const kBackground = [0.894, 0.894, 0.91]; // as in the pictures: darker than error 0, lighter than undefined
const kBoundaryInks = { B: [20 / 255, 20 / 255, 20 / 255], S: [120 / 255, 60 / 255, 160 / 255] };
const kTouchInk = [0, 114 / 255, 178 / 255];

function cssColour(rgb) { return "rgb(" + rgb.map(c => Math.round(255 * c)).join(",") + ")"; }

// Text on a pale ground, so that it is legible over any colour.
function drawText(context, text, x, y, { colour = kInk, align = "left", bold = false, ground = false } = {}) {
    context.font = (bold ? "600 " : "") + "12px sans-serif";
    context.textAlign = align;
    context.textBaseline = "middle";
    if (ground) {
        const width = context.measureText(text).width;
        const left = align === "left" ? x : align === "right" ? x - width : x - width / 2;
        context.fillStyle = kPaper;
        context.fillRect(left - 3, y - 8, width + 6, 16);
    }
    context.fillStyle = colour;
    context.fillText(text, x, y);
}

// Largest of 1, 2, 5 times a power of ten that is not above x.
function roundDown(x) {
    const power = 10 ** Math.floor(Math.log10(x));
    return (x >= 5 * power ? 5 : x >= 2 * power ? 2 : 1) * power;
}
// A number with four digits.
function short(value) { return Number.isFinite(value) ? String(Number(value.toPrecision(4))).replace("-", "\u2212") : "undefined"; }

function drawLegend(context, width, height, field) {
    const narrow = width <= kNarrow;
    const left = width - (narrow ? kNarrowLegendWidth : kLegendWidth) + 10;
    const classes = field.classes ?? [];
    let y = 20;
    context.fillStyle = kPaper;
    const bar = Math.min(300, height - 190);
    const tall = field.kind === "rgb" ? 24 : (classes.length > 0 ? 36 + 36 * classes.length : bar + (field.diverging ? 88 : 56)) + (field.undefined > 0 ? 24 : 0);
    context.fillRect(left - 8, 8, width - left, tall);
    drawText(context, field.name + (field.unit ? ", " + field.unit : ""), left, y, { bold: true });
    if (field.kind === "rgb") return;
    if (classes.length > 0) {
        for (const { name, count, colour } of classes) {
            y += 24;
            context.fillStyle = cssColour(colour.map(c => c / 255));
            context.fillRect(left, y - 6, 12, 12);
            drawText(context, name, left + 18, y);
            y += 14;
            drawText(context, String(count), left + 18, y, { colour: kSoft });
        }
    } else {
        if (field.diverging) drawText(context, "material left", left, y += 20, { colour: kSoft });
        const top = y + 18, count = field.colours.length / 3;
        for (let row = 0; row < bar; ++row) {
            const at = 3 * Math.min(count - 1, Math.floor((1 - (row + 0.5) / bar) * count));
            context.fillStyle = `rgb(${field.colours[at]},${field.colours[at + 1]},${field.colours[at + 2]})`;
            context.fillRect(left, top + row, 16, 1.5);
        }
        context.strokeStyle = "#aaaaaa";
        context.strokeRect(left + 0.5, top + 0.5, 16, bar);
        for (const { value, text } of field.ticks) {
            const tick = top + bar * (field.high - value) / (field.high - field.low);
            context.fillStyle = kSoft;
            context.fillRect(left + 16, tick - 0.5, 5, 1);
            drawText(context, text.replace("-", "\u2212"), left + 25, tick);
        }
        y = top + bar + 16;
        if (field.diverging) drawText(context, "over-cut", left, y, { colour: kSoft });
        else y -= 12;
    }
    if (field.undefined > 0) {
        y += 22;
        context.fillStyle = cssColour(kUndefinedColour);
        context.fillRect(left, y - 6, 12, 12);
        drawText(context, narrow ? "undefined" : "undefined: " + field.undefined, left + 18, y);
    }
}

// On a canvas of this height in the lower left corner.
function drawAxes(context, camera, unit) {
    const width = camera.width, height = kAxesHeight;
    // Scale bar, lower left; the axes beside it.
    const length = roundDown(width / 4 * camera.scale), pixels = length / camera.scale;
    drawText(context, short(length) + " " + unit, 24 + pixels, height - 22, { ground: true });
    context.fillStyle = kInk;
    context.fillRect(16, height - 24, pixels, 4);
    const centre = [48, height - 76];
    context.fillStyle = kPaper;
    context.beginPath();
    context.arc(...centre, 36, 0, 2 * Math.PI);
    context.fill();
    for (const [axis, name] of [[0, "x"], [1, "y"], [2, "z"]]) {
        const dx = camera.right[axis], dy = -camera.up[axis], size = Math.hypot(dx, dy);
        if (size < 0.2) continue;
        const colour = camera.eye[axis] < -1e-9 ? "#9a9a9a" : kInk;
        context.strokeStyle = colour;
        context.lineWidth = 2;
        context.beginPath();
        context.moveTo(...centre);
        context.lineTo(centre[0] + 22 * dx, centre[1] + 22 * dy);
        context.stroke();
        drawText(context, name, centre[0] + 22 * dx + 9 * dx / size, centre[1] + 22 * dy + 9 * dy / size, { colour, align: "center" });
    }
}

// A label with a leader to a place of the part, on the side where it covers neither one of `others` nor the legend.
function drawLabel(context, camera, point, text, others, colour = kInk) {
    const [x, y] = camera.project(point), end = camera.width - (camera.width > kNarrow ? kLegendWidth : kNarrowLegendWidth);
    context.font = "600 12px sans-serif";
    const width = context.measureText(text).width + 6;
    const boxes = [[1, -1], [-1, -1], [1, 1], [-1, 1]].map(([right, down]) => ({ right, down, left: right > 0 ? x + 16 : x - 16 - width, top: y + 22 * down - 8 }));
    const isFree = box => box.left >= 0 && box.left + width <= end && others.every(other =>
        box.left + width < other.left || other.left + other.width < box.left || Math.abs(box.top - other.top) > 17);
    const box = boxes.find(isFree) ?? boxes[0];
    others.push({ ...box, width });
    context.strokeStyle = colour;
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(x, y, 4, 0, 2 * Math.PI);
    context.moveTo(x + 3 * box.right, y + 3 * box.down);
    context.lineTo(x + 16 * box.right, y + 16 * box.down);
    context.stroke();
    drawText(context, text, box.left + 3, box.top + 8, { ground: true, bold: true, colour });
}

function drawPicks(context, camera, picks, current) {
    for (const name of ["S", "B"]) {
        const places = picks[name].map(pick => camera.project(pick));
        const colour = cssColour(kBoundaryInks[name]);
        if (places.length > 1) {
            for (const [ink, width] of [["#ffffff", 5], [colour, 2]]) {
                context.strokeStyle = ink;
                context.lineWidth = width;
                context.beginPath();
                places.forEach(([x, y], i) => i === 0 ? context.moveTo(x, y) : context.lineTo(x, y));
                if (places.length > 2) context.closePath();
                context.stroke();
            }
        }
        places.forEach(([x, y], i) => {
            context.fillStyle = "#ffffff";
            context.strokeStyle = colour;
            context.lineWidth = name === current ? 3 : 2;
            context.beginPath();
            context.arc(x, y, 6, 0, 2 * Math.PI);
            context.fill();
            context.stroke();
            drawText(context, name + (i + 1), x + 11, y - 11, { bold: true, ground: true, colour });
        });
    }
}

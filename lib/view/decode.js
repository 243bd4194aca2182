// The scene as the page carries it: JSON about the layers, and for each layer a block of deflated bytes in base64. Numbers of
// 16 bits come as differences from the one before, all low bytes first and then all high bytes (lib/view/encode.h).

async function inflate(base64) {
    const text = atob(base64);
    const packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Takes numbers from the block one array after the other.
class BlockReader {
    constructor(bytes) {
        this.bytes = bytes;
        this.at = 0;
    }
    // One column of 16 bits, into every `stride`-th place of `to` from `first` on.
    column16(to, first, stride, count) {
        const low = this.at, high = this.at + count;
        let value = 0;
        for (let i = 0; i < count; ++i) {
            value = (value + (this.bytes[low + i] | this.bytes[high + i] << 8)) & 0xffff;
            to[first + stride * i] = value;
        }
        this.at += 2 * count;
    }
    bytes8(to, first, stride, count) {
        for (let i = 0; i < count; ++i) to[first + stride * i] = this.bytes[this.at + i];
        this.at += count;
    }
    // Corners of triangles: each is the largest corner so far, plus one, minus a number of 32 bits.
    corners(count) {
        const to = new Uint32Array(count), bytes = this.bytes, at = this.at;
        let next = 0;
        for (let i = 0; i < count; ++i) {
            const back = bytes[at + i] | bytes[at + count + i] << 8 | bytes[at + 2 * count + i] << 16 | bytes[at + 3 * count + i] << 24;
            to[i] = next - back;
            if (to[i] === next) ++next;
        }
        this.at += 4 * count;
        return to;
    }
}

// Adds the arrays to a layer: `position` (3 x count), `normal` (2 x count) if it has them, `corners` (3 x triangles), and each
// field's `value` (16 bits) or `rgb`.
async function decodeLayer(layer, base64) {
    const reader = new BlockReader(await inflate(base64));
    const count = layer.count;
    layer.position = new Uint16Array(3 * count);
    for (let axis = 0; axis < 3; ++axis) reader.column16(layer.position, axis, 3, count);
    if (layer.normals) {
        layer.normal = new Int8Array(2 * count);
        for (let axis = 0; axis < 2; ++axis) reader.bytes8(layer.normal, axis, 2, count);
    }
    for (const field of layer.fields) {
        if (field.kind === "rgb") {
            field.rgb = new Uint8Array(3 * count);
            for (let channel = 0; channel < 3; ++channel) reader.bytes8(field.rgb, channel, 3, count);
        } else {
            field.value = new Uint16Array(count);
            reader.column16(field.value, 0, 1, count);
        }
    }
    layer.corners = reader.corners(3 * layer.triangles);
    layer.order = evenOrder(count);
    if (layer.triangles === 0) reorder(layer);
}

// Numbers from 0 to count - 1 by their reversed bits: along a curve through the part, the first of them are evenly spaced, however
// many one takes. A part is thinned so while it turns.
function evenOrder(count) {
    const order = new Uint32Array(count), bits = Math.max(1, Math.ceil(Math.log2(Math.max(2, count))));
    let found = 0;
    for (let k = 0; k < 2 ** bits; ++k) {
        let reversed = 0;
        for (let bit = 0, rest = k; bit < bits; ++bit, rest >>= 1) reversed = reversed << 1 | rest & 1;
        if (reversed < count) order[found++] = reversed;
    }
    return order;
}

// Points alone are put into that order.
function reorder(layer) {
    const sorted = (from, size) => {
        const to = new from.constructor(from.length);
        for (let i = 0; i < layer.count; ++i)
            for (let k = 0, at = size * layer.order[i]; k < size; ++k) to[size * i + k] = from[at + k];
        return to;
    };
    layer.position = sorted(layer.position, 3);
    layer.normal = sorted(layer.normal, 2);
    for (const field of layer.fields) {
        if (field.rgb) field.rgb = sorted(field.rgb, 3);
        else field.value = sorted(field.value, 1);
    }
    layer.order = undefined;
}

const kUndefined = 0xffff;

function fieldValue(field, index) {
    const code = field.value[index];
    return code === kUndefined ? NaN : field.origin + field.step * code;
}

function pointOf(layer, index) {
    const p = layer.position, at = 3 * index;
    return [layer.origin[0] + layer.step[0] * p[at], layer.origin[1] + layer.step[1] * p[at + 1], layer.origin[2] + layer.step[2] * p[at + 2]];
}

// Unit normal of a point: octahedral coordinates in two bytes (Meyer et al. 2010, On floating-point normal vectors).
function normalOf(layer, index) {
    let x = layer.normal[2 * index] / 127, y = layer.normal[2 * index + 1] / 127;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
    const length = Math.hypot(x, y, z);
    return [x / length, y / length, z / length];
}

// What lies under the pointer.

// The frontmost point of a layer at a pixel: { index, point, depth, value, normal }, or null. Of a mesh it lies on a triangle,
// and `index` is its nearest corner.
function pickAt(camera, layer, x, y) {
    return layer.triangles > 0 ? pickTriangle(camera, layer, x, y) : pickPoint(camera, layer, x, y);
}

// Pixel coordinates as affine functions of the layer's integers: x = c0 + cx * i + cy * j + cz * k.
function projection(camera, layer) {
    const start = camera.project(layer.origin);
    const to = axis => layer.step.map((step, k) => step * axis[k]);
    const right = to(camera.right).map(v => v / camera.scale), down = to(camera.up).map(v => -v / camera.scale), eye = to(camera.eye);
    return { start, right, down, eye };
}

function pickPoint(camera, layer, x, y) {
    const { start, right, down, eye } = projection(camera, layer);
    const p = layer.position, radius = Math.max(layer.count < kFewPoints ? 9 : 4, 1.1 * layer.spacing / camera.scale);
    let best = -1, bestDepth = -Infinity;
    const near = [];
    for (let i = 0, at = 0; i < layer.count; ++i, at += 3) {
        const a = p[at], b = p[at + 1], c = p[at + 2];
        const dx = start[0] + right[0] * a + right[1] * b + right[2] * c - x;
        if (dx > radius || dx < -radius) continue;
        const dy = start[1] + down[0] * a + down[1] * b + down[2] * c - y;
        if (dx * dx + dy * dy > radius * radius) continue;
        const depth = start[2] + eye[0] * a + eye[1] * b + eye[2] * c;
        near.push([i, dx * dx + dy * dy, depth]);
        if (depth > bestDepth) bestDepth = depth;
    }
    // The nearest to the pointer of those on the front surface is picked.
    const behind = Math.max(4 * layer.spacing, 4 * radius * camera.scale);
    let nearest = Infinity, depth = 0;
    for (const [i, distance, d] of near)
        if (d >= bestDepth - behind && distance < nearest) [best, nearest, depth] = [i, distance, d];
    return best < 0 ? null : { index: best, point: pointOf(layer, best), depth };
}

function pickTriangle(camera, layer, x, y) {
    const { start, right, down, eye } = projection(camera, layer);
    const p = layer.position, corners = layer.corners, u = new Float64Array(3), v = new Float64Array(3);
    let found = null;
    for (let t = 0; t < corners.length; t += 3) {
        for (let k = 0; k < 3; ++k) {
            const at = 3 * corners[t + k];
            u[k] = start[0] + right[0] * p[at] + right[1] * p[at + 1] + right[2] * p[at + 2] - x;
        }
        if (u[0] > 0 ? u[1] > 0 && u[2] > 0 : u[1] < 0 && u[2] < 0 && u[0] < 0) continue;
        for (let k = 0; k < 3; ++k) {
            const at = 3 * corners[t + k];
            v[k] = start[1] + down[0] * p[at] + down[1] * p[at + 1] + down[2] * p[at + 2] - y;
        }
        const a = u[1] * v[2] - u[2] * v[1], b = u[2] * v[0] - u[0] * v[2], c = u[0] * v[1] - u[1] * v[0], sum = a + b + c;
        if (sum === 0 || (sum > 0 ? a < 0 || b < 0 || c < 0 : a > 0 || b > 0 || c > 0)) continue;
        const weights = [a / sum, b / sum, c / sum];
        const depth = weights.reduce((total, w, k) => {
            const at = 3 * corners[t + k];
            return total + w * (start[2] + eye[0] * p[at] + eye[1] * p[at + 1] + eye[2] * p[at + 2]);
        }, 0);
        if (!found || depth > found.depth) found = { depth, weights, t };
    }
    if (!found) return null;
    const { depth, weights, t } = found;
    return { index: corners[t + weights.indexOf(Math.max(...weights))], point: camera.unproject(x, y, depth), depth };
}

// Inside the polygon, in plan view, as job::contains() decides away from the edge.
function contains(polygon, x, y) {
    let inside = false;
    for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
        const [xi, yi] = polygon[i], [xj, yj] = polygon[j];
        if (yi > y !== yj > y && x < xi + (xj - xi) * (y - yi) / (yj - yi)) inside = !inside;
    }
    return inside;
}

function regionOf(scene, point) {
    if (!scene.boundaries.B) return "";
    if (contains(scene.boundaries.B.corners, point[0], point[1])) return "inside B";
    if (scene.boundaries.S && contains(scene.boundaries.S.corners, point[0], point[1])) return "between B and S";
    return "outside";
}

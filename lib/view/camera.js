// Parallel projection as in the pictures of fettle-render: z of the machine is up on the screen, or y when one looks along z.

function dot(a, b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
function cross(a, b) { return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]; }
function subtract(a, b) { return [a[0] - b[0], a[1] - b[1], a[2] - b[2]]; }
function along(p, t, d) { return [p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]]; }

class Camera {
    // box: { min, max } of all layers   focus: of what fills the window at first
    constructor(box, focus) {
        this.box = box;
        this.focus = focus;
        this.radius = Math.max(1e-9, Math.hypot(...subtract(box.max, box.min)) / 2);
        this.width = this.height = 1;
        this.look(0.5, 0.75);
    }
    resize(width, height) {
        const fitted = this.scale === undefined || this.isFitted;
        this.width = width;
        this.height = height;
        if (fitted) this.fit(this.fitted);
    }
    // Angles in radians: azimuth turns about z, elevation is pi / 2 from above.
    look(azimuth, elevation) {
        this.azimuth = azimuth;
        this.elevation = elevation;
        this.update();
        this.fit();
    }
    turn(azimuth, elevation) {
        this.azimuth += azimuth;
        this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + elevation));
        this.update();
    }
    update() {
        const ca = Math.cos(this.azimuth), sa = Math.sin(this.azimuth), ce = Math.cos(this.elevation), se = Math.sin(this.elevation);
        this.right = [ca, sa, 0];
        this.eye = [sa * ce, -ca * ce, se]; // towards the eye
        this.up = cross(this.eye, this.right);
    }
    // What is in the box fills the window but for a margin, whose right side is the legend's.
    fit(box = this.focus) {
        this.fitted = box;
        const { min, max } = box;
        const half = direction => [0, 1, 2].reduce((sum, k) => sum + Math.abs(direction[k]) * (max[k] - min[k]) / 2, 0);
        const legend = this.width > kNarrow ? kLegendWidth : kNarrowLegendWidth;
        this.scale = Math.max(half(this.right) / Math.max(20, (this.width - legend) / 2 - 16), half(this.up) / Math.max(20, this.height / 2 - 56), 1e-9 * this.radius);
        this.centre = [0, 1, 2].map(k => (min[k] + max[k]) / 2);
        this.pan(-legend / 2, 0);
        this.isFitted = true;
    }
    // Moves the part with the pointer, pixels.
    pan(dx, dy) {
        this.centre = along(along(this.centre, -dx * this.scale, this.right), dy * this.scale, this.up);
        this.isFitted = false;
    }
    // The place under the pointer stays where it is.
    zoom(factor, x, y) {
        const smallest = 1e-5 * this.radius, largest = this.radius;
        const scale = Math.min(largest, Math.max(smallest, this.scale * factor));
        const ox = (x - this.width / 2) * (this.scale - scale), oy = (this.height / 2 - y) * (this.scale - scale);
        this.centre = along(along(this.centre, ox, this.right), oy, this.up);
        this.scale = scale;
        this.isFitted = false;
    }
    // Pixels from the upper left corner, and the depth towards the eye in the unit of the part.
    project(p) {
        const d = subtract(p, this.centre);
        return [this.width / 2 + dot(d, this.right) / this.scale, this.height / 2 - dot(d, this.up) / this.scale, dot(d, this.eye)];
    }
    // The point of a depth that is seen at a pixel.
    unproject(x, y, depth) {
        return along(along(along(this.centre, (x - this.width / 2) * this.scale, this.right), (this.height / 2 - y) * this.scale, this.up), depth, this.eye);
    }
}

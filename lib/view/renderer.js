// Draws layers with WebGL 2: points as squares, triangles, and lines and dots on the surface.

const kPartVertex = `#version 300 es
precision highp float;
uniform vec3 origin, cell;    // of the layer; origin from the camera's centre
uniform mat3 view;            // rows: right, up, towards the eye
uniform vec3 extent;          // half the window, and half the depth
uniform float dotSize, low, high;
uniform bool hasNormals;
in vec3 position;
in vec2 normal;
in float value;
in vec3 rgb;
out vec3 seen, facing, colour;
out float share;              // of the legend, 0 to 1; -1e9: undefined
void main() {
    vec3 p = view * (origin + cell * position);
    gl_Position = vec4(p / extent * vec3(1, 1, -1), 1);
    gl_PointSize = dotSize;
    seen = p;
    vec3 n = vec3(normal, 1.0 - abs(normal.x) - abs(normal.y));
    if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
    facing = hasNormals ? view * n : vec3(0);
    share = value > 65534.5 ? -1e9 : clamp((value - low) / (high - low), 0.0, 1.0);
    colour = rgb;
}`;

// Points: everything but the colour is done once a point, since a renderer without a GPU pays for each pixel.
const kPointVertex = kPartVertex.replace("out vec3 seen, facing, colour;", "flat out vec3 colour;\nvec3 seen, facing;")
    .replace("out float share;", "float share;")
    .replace("uniform bool hasNormals;", `uniform bool hasNormals, hasColours;
uniform sampler2D palette;
uniform float shading;
uniform vec3 undefinedColour;`)
    .replace("colour = rgb;", `vec3 c = hasColours ? rgb : share < -0.5 ? undefinedColour : texelFetch(palette, ivec2(int(clamp(share * 256.0, 0.0, 255.0)), 0), 0).rgb;
    float size = length(facing);
    if (size > 0.0) {
        n = facing * ((facing.z < 0.0 ? -1.0 : 1.0) / size);
        float light = min(1.0, dot(n, vec3(-0.406, 0.487, 0.773)) / 0.773);
        c *= 1.0 - shading * (1.0 - max(light, 0.0));
    }
    colour = c;`);
const kPointFragment = `#version 300 es
precision mediump float;
flat in vec3 colour;
out vec4 pixel;
void main() { pixel = vec4(colour, 1); }`;

// Light from the upper left; a surface that faces the eye has the legend's colour.
const kPartFragment = `#version 300 es
precision highp float;
uniform sampler2D palette;
uniform bool hasColours;
uniform float shading;
uniform vec3 undefinedColour;
in vec3 seen, colour;
in float share;
out vec4 pixel;
void main() {
    vec3 c = hasColours ? colour : share < -0.5 ? undefinedColour : texture(palette, vec2(clamp(share, 0.001953125, 0.998046875), 0.5)).rgb;
    vec3 n = cross(dFdx(seen), dFdy(seen));
    float size = length(n);
    if (size > 0.0) {
        n *= (n.z < 0.0 ? -1.0 : 1.0) / size;
        float light = min(1.0, dot(n, vec3(-0.406, 0.487, 0.773)) / 0.773);
        c *= 1.0 - shading * (1.0 - max(light, 0.0));
    }
    pixel = vec4(c, 1);
}`;

// A segment of a line is a quadrangle of constant width on the screen; a dot is one whose ends are equal.
const kLineVertex = `#version 300 es
precision highp float;
uniform mat3 view;
uniform vec3 centre, extent;
uniform vec2 pixel;           // size of a pixel in the window's coordinates
uniform float width, lift;    // lift: towards the eye, so that the surface does not hide the line
in vec3 from, to;
in vec2 corner;               // -1 or 1 along, -1 or 1 across
out vec2 place;
void main() {
    vec3 a = view * (from - centre), b = view * (to - centre);
    vec2 along = (b.xy - a.xy) / extent.xy / pixel;
    along = length(along) > 1e-6 ? normalize(along) : vec2(1, 0);
    vec3 p = (corner.x < 0.0 ? a : b) + vec3(0, 0, lift);
    vec2 shift = (along * corner.x + vec2(-along.y, along.x) * corner.y) * width * 0.5 * pixel;
    gl_Position = vec4(p / extent * vec3(1, 1, -1) + vec3(shift, 0), 1);
    place = corner;
}`;
const kLineFragment = `#version 300 es
precision highp float;
uniform vec3 ink;
uniform bool isRound;
in vec2 place;
out vec4 pixel;
void main() {
    if (isRound && length(place) > 1.0) discard;
    pixel = vec4(ink, 1);
}`;

function compile(gl, vertex, fragment) {
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, source);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const uniforms = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
        const name = gl.getActiveUniform(program, i).name;
        uniforms[name] = gl.getUniformLocation(program, name);
    }
    return { program, uniforms, attribute: name => gl.getAttribLocation(program, name) };
}

class Renderer {
    // @throws Error where there is no WebGL 2
    constructor(canvas) {
        const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, preserveDrawingBuffer: true });
        if (!gl) throw new Error("no WebGL 2");
        this.gl = gl;
        this.triangles = compile(gl, kPartVertex, kPartFragment);
        this.points = compile(gl, kPointVertex, kPointFragment);
        this.line = compile(gl, kLineVertex, kLineFragment);
        this.textures = new Map();
    }
    buffer(data, target = this.gl.ARRAY_BUFFER) {
        const buffer = this.gl.createBuffer();
        this.gl.bindBuffer(target, buffer);
        this.gl.bufferData(target, data, this.gl.STATIC_DRAW);
        return buffer;
    }
    attribute(program, name, buffer, size, type, normalized = false) {
        const gl = this.gl, at = program.attribute(name);
        if (at < 0) return;
        if (!buffer) {
            gl.disableVertexAttribArray(at);
            gl.vertexAttrib3f(at, 0, 0, 0);
            return;
        }
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        gl.enableVertexAttribArray(at);
        gl.vertexAttribPointer(at, size, type, normalized, 0, 0);
    }
    // Colours of a legend, 256 x rgb.
    palette(colours) {
        const gl = this.gl;
        if (!this.textures.has(colours)) {
            const texture = gl.createTexture();
            gl.bindTexture(gl.TEXTURE_2D, texture);
            gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
            gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, colours.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, colours);
            for (const [what, how] of [[gl.TEXTURE_MIN_FILTER, gl.NEAREST], [gl.TEXTURE_MAG_FILTER, gl.NEAREST], [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
                gl.texParameteri(gl.TEXTURE_2D, what, how);
            this.textures.set(colours, texture);
        }
        gl.bindTexture(gl.TEXTURE_2D, this.textures.get(colours));
    }
    begin(camera, pixelRatio, background) {
        const gl = this.gl;
        gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
        gl.clearColor(...background, 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LEQUAL);
        const offset = Math.hypot(...subtract(camera.centre, [0, 1, 2].map(k => (camera.box.min[k] + camera.box.max[k]) / 2)));
        this.extent = [camera.width / 2 * camera.scale, camera.height / 2 * camera.scale, 1.1 * camera.radius + offset];
        // Columns of the matrix that maps (x, y, z) to (right, up, eye).
        const { right: r, up: u, eye: e } = camera;
        this.view = [r[0], u[0], e[0], r[1], u[1], e[1], r[2], u[2], e[2]];
        this.camera = camera;
        this.pixelRatio = pixelRatio;
    }
    // @param points  how many of the layer's points to draw; triangles are drawn as points then; 0: all, and triangles
    drawLayer(layer, field, points) {
        const gl = this.gl, camera = this.camera, asPoints = points > 0 || layer.triangles === 0;
        const part = asPoints ? this.points : this.triangles, { program, uniforms } = part;
        layer.buffers ??= { position: this.buffer(layer.position), normal: layer.normal && this.buffer(layer.normal),
            corners: layer.triangles > 0 && this.buffer(layer.corners, gl.ELEMENT_ARRAY_BUFFER) };
        field.buffer ??= this.buffer(field.rgb ?? field.value);
        gl.useProgram(program);
        this.palette(field.colours ?? kNoColours);
        const count = points > 0 ? Math.min(points, layer.count) : layer.count;
        const cell = layer.spacing * Math.sqrt(layer.count / Math.max(1, count));
        gl.uniform3fv(uniforms.origin, subtract(layer.origin, camera.centre));
        gl.uniform3fv(uniforms.cell, layer.step);
        gl.uniformMatrix3fv(uniforms.view, false, this.view);
        gl.uniform3fv(uniforms.extent, this.extent);
        gl.uniform1f(uniforms.dotSize, Math.max(layer.count < kFewPoints ? 9 : 1.5, 1.5 * cell / camera.scale) * this.pixelRatio);
        gl.uniform1f(uniforms.low, field.step > 0 ? (field.low - field.origin) / field.step : 0);
        gl.uniform1f(uniforms.high, field.step > 0 ? (field.high - field.origin) / field.step : 1);
        gl.uniform1i(uniforms.hasNormals, layer.normal ? 1 : 0);
        gl.uniform1i(uniforms.hasColours, field.rgb ? 1 : 0);
        gl.uniform1f(uniforms.shading, field.shading);
        gl.uniform3fv(uniforms.undefinedColour, kUndefinedColour);
        this.attribute(part, "position", layer.buffers.position, 3, gl.UNSIGNED_SHORT);
        this.attribute(part, "normal", layer.buffers.normal, 2, gl.BYTE, true);
        this.attribute(part, "value", field.rgb ? null : field.buffer, 1, gl.UNSIGNED_SHORT);
        this.attribute(part, "rgb", field.rgb ? field.buffer : null, 3, gl.UNSIGNED_BYTE, true);
        if (asPoints && layer.order) { // of a mesh
            layer.buffers.order ??= this.buffer(layer.order, gl.ELEMENT_ARRAY_BUFFER);
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, layer.buffers.order);
            gl.drawElements(gl.POINTS, count, gl.UNSIGNED_INT, 0);
        } else if (asPoints) {
            gl.drawArrays(gl.POINTS, 0, count);
        } else {
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, layer.buffers.corners);
            gl.drawElements(gl.TRIANGLES, 3 * layer.triangles, gl.UNSIGNED_INT, 0);
        }
    }
    // @param points  [[x, y, z], …]; a line through them, or dots
    // @param above  1: over what was drawn with 0, whose segments reach half their width beyond their ends at the ends' depth
    drawLine(points, ink, width, isRound, above = 0) {
        const gl = this.gl, { program, uniforms } = this.line, camera = this.camera;
        const segments = isRound ? points.map(p => [p, p]) : points.slice(1).map((p, i) => [points[i], p]);
        if (segments.length === 0) return;
        const from = [], to = [], corner = [];
        for (const [a, b] of segments)
            for (const c of [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]]) {
                from.push(...subtract(a, camera.centre));
                to.push(...subtract(b, camera.centre));
                corner.push(...c);
            }
        gl.useProgram(program);
        gl.uniformMatrix3fv(uniforms.view, false, this.view);
        gl.uniform3fv(uniforms.centre, [0, 0, 0]);
        gl.uniform3fv(uniforms.extent, this.extent);
        gl.uniform2fv(uniforms.pixel, [2 / camera.width, 2 / camera.height]);
        gl.uniform1f(uniforms.width, width);
        gl.uniform1f(uniforms.lift, 0.008 * camera.radius + (2 + 6 * above) * camera.scale);
        gl.uniform1i(uniforms.isRound, isRound ? 1 : 0);
        gl.uniform3fv(uniforms.ink, ink);
        const buffers = [["from", from, 3], ["to", to, 3], ["corner", corner, 2]].map(([name, data, size]) => {
            const buffer = this.buffer(new Float32Array(data));
            this.attribute(this.line, name, buffer, size, gl.FLOAT);
            return buffer;
        });
        gl.drawArrays(gl.TRIANGLES, 0, 6 * segments.length);
        for (const buffer of buffers) gl.deleteBuffer(buffer);
    }
}

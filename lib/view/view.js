// The view in a page: an element of class fettle-view that holds its scene, its data, and the picture shown where WebGL is missing.

const kMaxFrame = 42;          // ms: a turning part is thinned where a frame takes longer
const kRelaxedFrame = 24;      // ms: and drawn with more points where it takes less
const kRedrawDelay = 180;      // ms without a motion: then all is drawn
const kClickDistance = 4;      // pixels that a click may move
const kHelp = "Drag: turn. Right button, Shift or two fingers: move. Wheel or two fingers: zoom. Keys: arrows, +, \u2212, 0 all, t top, f front, r right, " +
    "1\u20139 layers, s section, Esc.";

function make(name, attributes = {}, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
}

class View {
    constructor(root) {
        this.root = root;
        this.scene = JSON.parse(root.querySelector(".scene").textContent);
        this.layers = this.scene.layers;
        this.blocks = [...root.querySelectorAll(".block")];
        for (const layer of this.layers)
            for (const field of layer.fields) if (field.colours) field.colours = Uint8Array.from(atob(field.colours), c => c.charCodeAt(0));
        this.camera = new Camera(this.scene.box, this.scene.focus);
        this.camera.look(...(this.scene.pick ? [0, Math.PI / 2] : [0.45, 0.7]));
        this.pointers = new Map();
        this.mode = "turn";
        this.picks = { B: [], S: [] };
        this.history = [];
        this.boundary = "B";
        this.budget = 80000;
        this.frames = 0;
    }
    async start() {
        this.build();
        this.renderer = new Renderer(this.canvas);
        this.canvas.addEventListener("webglcontextlost", () => this.root.classList.add("without-webgl"));
        this.root.classList.add("with-webgl");
        this.listen();
        await this.show(0, 0);
        this.moving = true; // the first picture is thinned, as while turning
        this.resize();
        this.draw();
        this.root.dataset.firstFrame = Math.round(performance.now());
        this.move();
        for (let i = 1; i < this.layers.length; ++i) await this.decode(i);
        this.requestDraw();
        this.root.dataset.ready = "all";
    }
    async decode(index) {
        const layer = this.layers[index];
        layer.decoding ??= decodeLayer(layer, this.blocks[index].textContent);
        await layer.decoding;
        this.blocks[index].textContent = "";
    }
    async show(layer, field) {
        this.current = layer;
        await this.decode(layer);
        if (this.current !== layer) return;
        this.layer = this.layers[layer];
        this.field = this.layer.fields[Math.min(field, this.layer.fields.length - 1)];
        this.layerButtons.forEach((button, i) => button.setAttribute("aria-pressed", i === layer));
        this.fieldButtons.replaceChildren(...(this.layer.fields.length < 2 ? [] : this.layer.fields.map((f, i) =>
            this.button(f.name, () => this.show(layer, i), f === this.field))));
        this.updateProfile();
        this.requestDraw();
    }

    // --- elements ---
    button(text, action, pressed) {
        const button = make("button", { type: "button" }, text);
        if (pressed !== undefined) button.setAttribute("aria-pressed", pressed);
        button.addEventListener("click", action);
        return button;
    }
    build() {
        this.layerButtons = this.layers.map((layer, i) => this.button(layer.name, () => this.show(i, 0), false));
        this.fieldButtons = make("span", { class: "group" });
        const look = (text, azimuth, elevation) => this.button(text, () => { this.camera.look(azimuth, elevation); this.requestDraw(); });
        this.modeButtons = { turn: this.button("Turn", () => this.setMode("turn"), true), section: this.button("Section", () => this.setMode("section"), false) };
        if (this.scene.pick) this.modeButtons.pick = this.button("Pick", () => this.setMode("pick"), false);
        const bar = make("div", { class: "bar", role: "toolbar" },
            make("span", { class: "group" }, ...this.layerButtons), this.fieldButtons, make("span", { class: "group" }, ...Object.values(this.modeButtons)),
            make("span", { class: "group" }, look("Top", 0, Math.PI / 2), look("Front", 0, 0), look("Right", Math.PI / 2, 0), look("Oblique", 0.45, 0.7)));
        this.canvas = make("canvas", { tabindex: "0", role: "img", "aria-label": "Rotatable view of the part. " + kHelp });
        // Canvases over the part are as small as what they show: each is laid over it anew in every frame.
        const over = name => make("canvas", { class: "over " + name, "aria-hidden": "true" });
        this.legend = over("legend");
        this.axes = over("axes");
        this.overlay = over("labels");
        this.tip = make("div", { class: "tip", role: "status" });
        this.stage = make("div", { class: "stage" }, this.canvas, this.legend, this.axes, this.overlay, this.tip);
        this.profile = make("canvas", { class: "profile", hidden: "" });
        this.root.prepend(bar, this.stage, this.profile, ...(this.scene.pick ? [this.buildPicks()] : []), make("p", { class: "help" }, kHelp));
    }
    buildPicks() {
        this.list = make("textarea", { class: "picks", readonly: "", rows: "6", "aria-label": "picked corners" });
        const boundary = name => this.button(name === "B" ? "Corners of B (around the anomaly)" : "Corners of S (may be touched)", () => {
            this.boundary = name;
            this.setMode("pick");
        }, name === "B");
        this.boundaryButtons = { B: boundary("B"), S: boundary("S") };
        const download = this.button("Download", () => {
            const link = make("a", { href: URL.createObjectURL(new Blob([this.list.value], { type: "text/plain" })), download: "picks.txt" });
            link.click();
            URL.revokeObjectURL(link.href);
        });
        const copy = this.button("Copy", () => {
            this.list.select();
            if (navigator.clipboard) navigator.clipboard.writeText(this.list.value).catch(() => document.execCommand("copy"));
            else document.execCommand("copy");
        });
        return make("div", { class: "picking" },
            make("div", { class: "bar" }, make("span", { class: "group" }, ...Object.values(this.boundaryButtons)),
                make("span", { class: "group" }, this.button("Undo", () => this.undo()), copy, download)), this.list);
    }
    setMode(mode) {
        this.mode = mode;
        for (const [name, button] of Object.entries(this.modeButtons)) button.setAttribute("aria-pressed", name === mode);
        if (this.boundaryButtons)
            for (const [name, button] of Object.entries(this.boundaryButtons)) button.setAttribute("aria-pressed", mode === "pick" && name === this.boundary);
        this.canvas.style.cursor = mode === "turn" ? "grab" : "crosshair";
        this.requestDraw();
    }

    // --- drawing ---
    resize() {
        const { width, height } = this.stage.getBoundingClientRect();
        if (width === 0 || height === 0) return;
        this.ratio = Math.min(2, window.devicePixelRatio || 1);
        const legend = width > kNarrow ? kLegendWidth : kNarrowLegendWidth;
        for (const [canvas, w, h] of [[this.canvas, width, height], [this.overlay, width, height], [this.legend, legend, height], [this.axes, Math.min(width, width / 4 + 130), kAxesHeight]]) {
            canvas.width = Math.round(w * this.ratio);
            canvas.height = Math.round(h * this.ratio);
            canvas.style.width = w + "px";
            canvas.style.height = h + "px";
        }
        this.legendOf = undefined;
        this.camera.resize(width, height);
        this.updateProfile();
        this.requestDraw();
    }
    requestDraw() {
        if (this.pending) return;
        this.pending = true;
        requestAnimationFrame(() => {
            this.pending = false;
            this.draw();
        });
    }
    // The part is drawn at this share of the window's resolution: less while it turns, where frames take long.
    sharpness(share) {
        const width = Math.round(this.camera.width * this.ratio * share), height = Math.round(this.camera.height * this.ratio * share);
        if (this.canvas.width === width && this.canvas.height === height) return;
        this.canvas.width = width;
        this.canvas.height = height;
    }
    // A motion of the part: thinned until it is over.
    move() {
        const now = performance.now();
        if (!this.moving) this.lastFrame = undefined;
        this.moving = true;
        clearTimeout(this.stillTimer);
        this.stillTimer = setTimeout(() => {
            this.moving = false;
            this.requestDraw();
        }, kRedrawDelay);
        this.movedAt = now;
        this.requestDraw();
    }
    // How many points a moving layer is drawn with, by what the last frames took; 0: all, and triangles.
    thinned() {
        if (!this.moving) return 0;
        const now = performance.now(), frame = now - (this.lastFrame ?? now);
        this.lastFrame = now;
        if (frame > 0 && frame < 500) {
            this.isSlow = frame > kMaxFrame || (this.isSlow && frame > kRelaxedFrame);
            if (frame > kMaxFrame) this.budget = Math.max(15000, 0.8 * this.budget);
            else if (frame < kRelaxedFrame) this.budget = Math.min(2e6, 1.05 * this.budget);
        }
        const cost = this.layer.triangles > 0 ? this.layer.triangles : this.layer.count;
        return cost > this.budget ? Math.min(this.layer.count, Math.round(this.budget)) : 0;
    }
    draw() {
        if (!this.layer) return;
        const { renderer, camera } = this;
        const points = this.thinned(), share = this.moving && this.isSlow ? 0.5 : 1;
        this.sharpness(share);
        renderer.begin(camera, this.ratio * share, kBackground);
        renderer.drawLayer(this.layer, this.field, points);
        for (const name of ["S", "B"]) {
            const boundary = this.scene.boundaries[name];
            if (!boundary) continue;
            renderer.drawLine([...boundary.line, boundary.line[0]], [1, 1, 1], name === "B" ? 5 : 4, false);
            renderer.drawLine([...boundary.line, boundary.line[0]], kBoundaryInks[name], name === "B" ? 2 : 1.5, false, 1);
        }
        if (this.scene.touches.length > 0) {
            renderer.drawLine(this.scene.touches, [1, 1, 1], 10, true);
            renderer.drawLine(this.scene.touches, kTouchInk, 7, true, 1);
        }
        this.drawOverlay();
        this.root.dataset.frames = ++this.frames;
    }
    drawOverlay() {
        const { camera } = this;
        this.drawLegendOnce();
        const below = this.axes.getContext("2d", { willReadFrequently: true });
        below.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
        below.clearRect(0, 0, camera.width, kAxesHeight);
        drawAxes(below, camera, this.scene.unit);
        const hasLabels = !this.moving || this.line || Object.keys(this.scene.boundaries).length > 0 || this.picks.B.length + this.picks.S.length > 0;
        this.overlay.style.display = hasLabels ? "" : "none";
        if (!hasLabels) return;
        const context = this.overlay.getContext("2d", { willReadFrequently: true });
        context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
        context.clearRect(0, 0, camera.width, camera.height);
        for (const name of ["S", "B"]) {
            const boundary = this.scene.boundaries[name];
            if (!boundary) continue;
            const top = boundary.line.map(p => camera.project(p)).reduce((a, b) => b[1] < a[1] ? b : a);
            drawText(context, name, top[0], top[1] - 12, { bold: true, align: "center", colour: cssColour(kBoundaryInks[name]), ground: true });
        }
        const labels = [];
        if (!this.moving)
            for (const { point, text } of this.field.extremes ?? []) {
                const [x, y, depth] = camera.project(point), front = pickAt(camera, this.layer, x, y);
                const hidden = front && front.depth > depth + 0.02 * camera.radius;
                drawLabel(context, camera, point, text + (hidden ? " (behind)" : ""), labels, hidden ? "#8a8a8a" : kInk);
            }
        if (this.line) {
            context.strokeStyle = "#d55e00";
            context.lineWidth = 2;
            context.beginPath();
            context.moveTo(...camera.project(this.line[0]));
            context.lineTo(...camera.project(this.line[1]));
            context.stroke();
        }
        drawPicks(context, camera, this.picks, this.mode === "pick" ? this.boundary : "");
        if (this.field.summary && camera.width > kNarrow)
            drawText(context, this.field.summary, camera.width - 12, camera.height - 22, { align: "right", ground: true });
    }
    // The legend changes with the field and the window alone.
    drawLegendOnce() {
        if (this.legendOf === this.field) return;
        this.legendOf = this.field;
        const { camera } = this, context = this.legend.getContext("2d", { willReadFrequently: true });
        const width = camera.width > kNarrow ? kLegendWidth : kNarrowLegendWidth;
        context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
        context.clearRect(0, 0, width, camera.height);
        context.translate(width - camera.width, 0);
        drawLegend(context, camera.width, camera.height, this.field);
    }
    updateProfile() {
        this.profile.hidden = !this.plane;
        if (!this.plane || !this.layer) return;
        const curves = profileCurves(this.layers, this.layer, this.field, this.plane);
        const { width, height } = this.profile.getBoundingClientRect();
        this.profile.width = Math.round(width * this.ratio);
        this.profile.height = Math.round(height * this.ratio);
        const context = this.profile.getContext("2d");
        context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
        drawProfile(context, width, height, this.plane, curves, this.scene.unit);
        this.profile.dataset.curves = JSON.stringify(curves.map(({ name, pieces }) => ({ name, points: pieces.reduce((n, piece) => n + piece.length, 0) })));
        this.curves = curves;
    }
}

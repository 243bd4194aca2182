// What pointers and keys do in a view, and the corners that are picked in it.

class SteeredView extends View {
    // --- pointing ---
    showTip(x, y) {
        const found = this.layer && pickAt(this.camera, this.layer, x, y);
        this.tip.hidden = !found;
        if (!found) return;
        const { point, index } = found, { field, scene } = this;
        const lines = ["x", "y", "z"].map((name, k) => name + " " + short(Number(point[k].toPrecision(6)))).join("  ") + " " + scene.unit;
        let value = "";
        if (!field.rgb) {
            const v = fieldValue(field, index), found = (field.classes ?? []).find(c => c.value === v);
            value = `${field.name} ${found ? found.name : short(v) + (Number.isFinite(v) && field.unit ? " " + field.unit : "")}`;
        }
        this.tip.replaceChildren(make("span", {}, lines), ...[value, regionOf(scene, point)].filter(t => t).map(t => make("span", {}, t)));
        this.tip.style.left = Math.min(x + 14, this.camera.width - 200) + "px";
        this.tip.style.top = Math.max(4, Math.min(y + 14, this.camera.height - 70)) + "px";
    }
    place(event) {
        const box = this.canvas.getBoundingClientRect();
        return [event.clientX - box.left, event.clientY - box.top];
    }
    listen() {
        const { canvas } = this;
        new ResizeObserver(() => this.resize()).observe(this.stage);
        canvas.addEventListener("pointerdown", event => this.down(event));
        canvas.addEventListener("pointermove", event => this.moved(event));
        for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, event => this.up(event));
        canvas.addEventListener("pointerleave", event => { if (event.pointerType !== "touch") this.tip.hidden = true; }); // a finger leaves as it is lifted
        canvas.addEventListener("contextmenu", event => event.preventDefault());
        canvas.addEventListener("wheel", event => {
            // In a page with more than the view the wheel scrolls until the view has been clicked.
            if (this.root.closest(".view") && document.activeElement !== canvas) return;
            event.preventDefault();
            this.camera.zoom(Math.exp(0.0015 * event.deltaY), ...this.place(event));
            this.move();
        }, { passive: false });
        canvas.addEventListener("keydown", event => this.key(event));
    }
    down(event) {
        this.canvas.focus({ preventScroll: true });
        this.canvas.setPointerCapture(event.pointerId);
        const at = this.place(event);
        this.pointers.set(event.pointerId, at);
        this.drag = { from: at, at, moved: false, pan: event.button === 2 || event.shiftKey };
        if (this.mode === "section" && !this.drag.pan && this.pointers.size === 1) this.drag.section = true;
        if (this.mode === "pick" && this.pointers.size === 1) this.drag.corner = this.cornerAt(at);
        this.tip.hidden = true;
    }
    moved(event) {
        const at = this.place(event);
        if (!this.pointers.has(event.pointerId)) {
            if (this.pointers.size > 0 || event.pointerType === "touch") return;
            this.hoverAt = at;
            this.hover ??= requestAnimationFrame(() => {
                this.hover = undefined;
                this.showTip(...this.hoverAt);
            });
            return;
        }
        const before = this.pointers.get(event.pointerId), drag = this.drag;
        const dx = at[0] - before[0], dy = at[1] - before[1];
        if (this.pointers.size === 2) {
            const other = [...this.pointers.entries()].find(([id]) => id !== event.pointerId)[1];
            const distance = p => Math.max(1, Math.hypot(p[0] - other[0], p[1] - other[1]));
            this.camera.zoom(distance(before) / distance(at), other[0], other[1]);
            this.camera.pan(dx / 2, dy / 2);
            drag.moved = true;
            drag.section = drag.corner = undefined;
            this.move();
        } else if (Math.hypot(at[0] - drag.from[0], at[1] - drag.from[1]) > kClickDistance || drag.moved) {
            drag.moved = true;
            if (drag.section) {
                this.line = [this.camera.unproject(...drag.from, 0), this.camera.unproject(...at, 0)];
                this.requestDraw();
            } else if (drag.corner) {
                this.moveCorner(drag.corner, at);
            } else if (drag.pan) {
                this.camera.pan(dx, dy);
                this.move();
            } else {
                this.camera.turn(-0.008 * dx, 0.008 * dy);
                this.move();
            }
        }
        this.pointers.set(event.pointerId, at);
    }
    up(event) {
        const drag = this.drag;
        this.pointers.delete(event.pointerId);
        if (this.pointers.size > 0 || !drag || event.type === "pointercancel") return;
        this.drag = undefined;
        const at = this.place(event);
        if (drag.section && drag.moved) {
            this.plane = sectionPlane(this.camera, drag.from, at);
            this.profile.hidden = !this.plane;
            this.updateProfile();
        } else if (!drag.moved && this.mode === "pick" && !drag.pan && !drag.corner) {
            this.addCorner(at);
        } else if (!drag.moved) {
            this.showTip(...at); // a tap tells what a pointer does that hovers
        }
        this.requestDraw();
    }
    key(event) {
        const step = Math.PI / 36, { camera } = this;
        const pan = event.shiftKey ? 30 : 0;
        const turn = (a, e) => () => { pan ? camera.pan(-pan * Math.sign(a), -pan * Math.sign(e)) : camera.turn(a, e); this.move(); };
        const look = (a, e) => () => { camera.look(a, e); this.requestDraw(); };
        const zoom = factor => () => { camera.zoom(factor, camera.width / 2, camera.height / 2); this.move(); };
        const all = () => { camera.fit(camera.box); this.requestDraw(); };
        const actions = {
            ArrowLeft: turn(step, 0), ArrowRight: turn(-step, 0), ArrowUp: turn(0, step), ArrowDown: turn(0, -step),
            "+": zoom(0.8), "=": zoom(0.8), "-": zoom(1.25), "0": all, Home: all,
            t: look(0, Math.PI / 2), f: look(0, 0), r: look(Math.PI / 2, 0), s: () => this.setMode("section"), p: () => this.scene.pick && this.setMode("pick"),
            Escape: () => { this.line = this.plane = undefined; this.updateProfile(); this.setMode("turn"); },
        };
        if ((event.ctrlKey || event.metaKey) && event.key === "z") this.undo();
        else if (event.ctrlKey || event.metaKey || event.altKey) return;
        else if (/^[1-9]$/.test(event.key) && this.layers[event.key - 1]) this.show(event.key - 1, 0);
        else if (actions[event.key]) actions[event.key]();
        else return;
        event.preventDefault();
    }

    // --- corners of B and S ---
    cornerAt([x, y]) {
        for (const name of [this.boundary, this.boundary === "B" ? "S" : "B"])
            for (let i = 0; i < this.picks[name].length; ++i) {
                const [cx, cy] = this.camera.project(this.picks[name][i]);
                if (Math.hypot(cx - x, cy - y) < 10) return { name, index: i };
            }
        return undefined;
    }
    remember() { this.history.push(JSON.stringify(this.picks)); }
    addCorner([x, y]) {
        const found = pickAt(this.camera, this.layer, x, y);
        if (!found) return;
        this.remember();
        this.picks[this.boundary].push(found.point);
        this.listPicks();
    }
    moveCorner(corner, [x, y]) {
        const found = pickAt(this.camera, this.layer, x, y);
        if (!found) return;
        if (!corner.remembered) this.remember();
        corner.remembered = true;
        this.picks[corner.name][corner.index] = found.point;
        this.listPicks();
    }
    undo() {
        if (this.history.length === 0) return;
        this.picks = JSON.parse(this.history.pop());
        this.listPicks();
    }
    // The lines that fettle-teach reads: a label and three numbers, in the frame of the part.
    listPicks() {
        const matrix = this.scene.toPart;
        const text = ["B", "S"].flatMap(name => this.picks[name].map((p, i) => {
            const moved = matrix ? matrix.map(row => dot(row, p) + row[3]) : p;
            return [name + (i + 1), ...moved.map(v => Number(v.toPrecision(8)))].join(",") + "\n";
        }));
        this.list.value = "# corners picked with fettle-view\n# units " + this.scene.unit + "\n" + text.join("");
        this.requestDraw();
    }
}

for (const root of document.querySelectorAll(".fettle-view")) {
    const view = root.fettleView = new SteeredView(root);
    view.start().catch(error => {
        root.classList.remove("with-webgl");
        root.classList.add("without-webgl");
        root.dataset.error = String(error.message);
    });
}

// {dh-robot}: a whole arm, its joints to move, its frames in both conventions, its tables and T.

import { LiveFigure, Matrix, Slider, choice } from "./figure.js";
import { make } from "./make.js";
import { add, along, column, cross, elbowCircle, forward, frames, length, moveElbow, origin, parameters, scale, subtract } from "./kinematics.js";
import { Stage, hold, orbit } from "./stage.js";
import { Table } from "./table.js";
import { DEGREE, degrees, entry, html, point, short } from "./words.js";

const FRAMES = ["classic", "modified", "both", "none"];
const LONGEST_TRACE = 1500;

const script = document.currentScript.src;

/** The script with three.js, asked for once. */
let space = null;
const loadSpace = () => (space ??= new Promise((done) => {
  document.head.append(make("script", { src: script.replace("robot.js", "space.js"), load: () => done(globalThis.DhSpace), error: () => done(null) }));
}));

class DhRobot extends LiveFigure {
  build() {
    const data = (name) => JSON.parse(this.getAttribute(name));
    this.start = { figure: data("figure"), q: data("q"), frames: this.getAttribute("convention") };
    this.shown = this.start.frames;
    this.reference = null;

    this.choice = choice({
      legend: "Frames", value: this.shown, options: FRAMES.map((name) => [name, name === "none" ? "no frames" : name]),
      changed: (name) => { this.shown = name; this.#arrange(); this.due(); },
    });
    this.tracing = this.#check("path of the tool", (on) => { this.trace = on ? [] : null; });
    this.circling = this.#check("elbow circle", () => {});
    this.picker = make("select", { change: () => { this.link = this.picker.value === "" ? null : Number(this.picker.value); this.due(); } });
    this.legend = make("span", { class: "legend" }, "c: classic, solid; m: modified, dashed");
    this.note = make("p", { class: "note", role: "status" });
    const share = make("button", { type: "button", click: () => this.share({ q: this.q.map((value) => short(value, 4).replace("−", "-")).join(" "), frames: this.shown }, share) }, "Copy link");
    const reset = make("button", { type: "button", click: () => this.reset() }, "Reset");

    this.canvas = make("canvas", { "aria-hidden": "true" });
    this.picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    this.picture.setAttribute("role", "img");
    this.stage = new Stage(this.picture, () => this.due());
    this.ground = make("div", { class: "stage", tabindex: 0, role: "group", "aria-label": "The arm. The arrow keys turn the view, Home turns it back." }, this.canvas, this.picture);
    orbit(this.ground, this.stage);
    hold(this.ground, this.stage, () => this.#elbowGrip());

    this.rows = make("div", { class: "sliders" });
    this.matrix = new Matrix("Pose of the tool, <i>T</i>");
    this.sentence = make("p", { class: "sentence", "aria-hidden": "true" });
    this.both = make("div", { class: "tables" });
    this.live.classList.add("robot");
    this.live.append(
      make("div", { class: "bar" }, this.choice.element, make("span", { class: "gap" }), reset, share),
      this.note,
      this.ground,
      make("div", { class: "bar more" }, this.tracing.element, this.circling.element, make("label", { class: "pick" }, "Show ", this.picker), this.legend),
      this.rows,
      make("div", { class: "beside" }, this.matrix.element, this.sentence),
      this.both,
    );
    this.#equip(this.start.figure, this.start.q);
    new ResizeObserver(([{ contentRect: { width, height } }]) => {
      if (!width) return;
      this.stage.resize(width, height);
      this.draw();
    }).observe(this.ground);
    this.#wakeWhenNear();
  }

  /** Take an arm, and give it sliders and tables of its own. */
  #equip(figure, q) {
    this.figure = figure;
    this.arms = { classic: figure.classic, modified: figure.modified };
    this.arm = this.arms.classic;
    Object.assign(this, { heights: figure.heights, size: figure.size, q: [...q], link: null, moved: null, marked: null, reference: null });
    this.digits = this.size > 20 ? 1 : 3;
    this.trace = this.tracing.box.checked ? [] : null;
    this.stage.camera = null;
    this.note.hidden = figure === this.start.figure;
    this.note.textContent = this.note.hidden ? "" : `From a cell: ${this.arm.name || `an arm with ${q.length} joints`}. Reset brings the first arm back.`;
    this.circling.element.hidden = !figure.elbow;
    if (!figure.elbow) this.circling.box.checked = false;
    this.picker.replaceChildren(make("option", { value: "" }, "no link"), ...[...q, 0].map((_, k) => make("option", { value: k }, `link ${k}`)));
    this.sliders = q.map((_, k) => this.#slider(k));
    this.elbow = figure.elbow ? this.#elbowSlider() : null;
    this.rows.replaceChildren(...this.sliders.map(({ element }) => element), ...(this.elbow ? [this.elbow.element] : []));
    this.tables = Object.fromEntries(["classic", "modified"].map((name) => [name, new Table(name, this.arms[name].joints.map(({ kind }) => kind))]));
    this.both.replaceChildren(this.tables.classic.element, this.tables.modified.element);
    this.#arrange();
    this.#readElbow();
  }

  #check(text, changed) {
    const box = make("input", { type: "checkbox", change: () => { changed(box.checked); this.due(); } });
    return { element: make("label", { class: "check" }, box, make("span", {}, text)), box };
  }

  #slider(k) {
    const { kind, limits } = this.arm.joints[k];
    const turns = kind === "R";
    const factor = turns ? 1 / DEGREE : 1;
    const [low, high] = (limits ?? (turns ? [-Math.PI, Math.PI] : [-this.size, this.size])).map((limit) => limit * factor);
    const step = turns ? 1 : (high - low) / 200;
    return new Slider({
      symbol: `q_${k + 1}`, word: turns ? "turns" : "slides", style: "z", unit: turns ? "°" : this.arm.unit, heard: turns ? "degrees" : this.arm.unit,
      low: turns ? Math.ceil(low - 1e-9) : low, high: turns ? Math.floor(high + 1e-9) : high, step, digits: turns ? 0 : 3, value: this.q[k] * factor,
      changed: (value, done) => this.change(k, value / factor, done),
    });
  }

  #elbowSlider() {
    const value = elbowCircle(this.arm, this.q).angle / DEGREE;
    return new Slider({
      symbol: "ψ", word: "elbow, hand at rest", style: "elbow", unit: "°", heard: "degrees",
      low: -180, high: 180, step: 1, digits: 1, value, changed: (degrees, done) => this.turnElbow(degrees, done),
    });
  }

  #arrange() {
    this.choice.set(this.shown);
    this.legend.hidden = this.shown !== "both";
    this.tables.classic.element.hidden = this.shown === "modified";
    this.tables.modified.element.hidden = this.shown === "classic";
  }

  /** Fetch three.js when the figure is nearly in view; where there is no WebGL the flat drawing stays. */
  #wakeWhenNear() {
    // A busy page tells of several moments at once: what counts is whether the figure was near at any of them.
    const watch = new IntersectionObserver(async (moments) => {
      if (!moments.some(({ isIntersecting }) => isIntersecting)) return;
      watch.disconnect();
      const Space = await loadSpace();
      try {
        this.space = new Space(this.canvas);
      } catch {
        this.canvas.remove();
        return;
      }
      this.#paint();
      new MutationObserver(() => { this.#paint(); this.due(); }).observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
      this.due();
    }, { rootMargin: "400px" });
    watch.observe(this);
  }

  #paint() {
    const style = getComputedStyle(this);
    const colour = (name) => style.getPropertyValue(`--dh-${name}`).trim();
    // Light and shade tell the bodies apart; all of them have to stand out from the ground.
    const mixed = (part) => [colour("muted"), colour("ground"), part];
    this.space.paint({ body: mixed(0.25), faint: mixed(0.12), muted: mixed(0), accent: [colour("accent"), colour("ground"), 0] });
  }

  // What a reader does

  change(k, value, done) {
    this.reference ??= forward(this.arm, this.q);
    this.marked = this.reference;
    this.q[k] = value;
    this.moved = k;
    this.#readElbow();
    if (done) this.reference = null;
    this.due();
  }

  /** Turn the elbow to an angle of its circle, in degrees, as far as the joints allow. */
  turnElbow(degrees, done) {
    const { q, angle, stopped } = moveElbow(this.arm, this.q, degrees * DEGREE - this.elbowAngle);
    this.q = q;
    this.marked = null;
    this.moved = null;
    this.elbowAngle += angle;
    this.turned = { stopped };
    this.circling.box.checked = true;
    this.sliders.forEach((slider, k) => slider.set(q[k] / DEGREE));
    if (stopped !== null && done) this.elbow.set(this.elbowAngle / DEGREE);
    this.due();
  }

  /** Where the elbow is, after joints were moved one by one. */
  #readElbow() {
    this.turned = null;
    if (!this.elbow) return;
    this.elbowAngle = elbowCircle(this.arm, this.q).angle;
    this.elbow.set(this.elbowAngle / DEGREE);
  }

  #elbowGrip() {
    const { centre, axis, start, radius } = elbowCircle(this.arm, this.q);
    const side = cross(axis, start);
    return {
      value: this.elbowAngle,
      around: (angle) => add(centre, add(scale(radius * Math.cos(angle), start), scale(radius * Math.sin(angle), side))),
      changed: (angle, done) => this.elbow.move(angle / DEGREE, done),
    };
  }

  reset() {
    this.shown = this.start.frames;
    this.#equip(this.start.figure, this.start.q);
    this.stage.turn();
    this.due();
  }

  read(address) {
    const values = (address.get("q") ?? "").trim().split(/[\s+]+/).map(Number);
    if (values.length === this.q.length && values.every(Number.isFinite)) {
      this.q = values.map((value, k) => {
        const { low, high } = this.sliders[k];
        const factor = this.arm.joints[k].kind === "R" ? DEGREE : 1;
        return Math.max(low * factor, Math.min(high * factor, value));
      });
    }
    if (FRAMES.includes(address.get("frames"))) this.shown = address.get("frames");
    this.#arrange();
    this.#showValues();
    this.due();
  }

  #showValues() {
    this.sliders.forEach((slider, k) => slider.set(this.arm.joints[k].kind === "R" ? this.q[k] / DEGREE : this.q[k]));
    this.#readElbow();
  }

  // What the cells of the page see and change

  get joints() {
    return [...this.q];
  }

  get forCells() {
    return { kind: "robot", q: this.joints, chain: this.arms.classic };
  }

  take({ figure, q }) {
    if (figure && JSON.stringify(figure) !== JSON.stringify(this.figure)) this.#equip(figure, q);
    this.q = [...q];
    this.moved = null;
    this.marked = null;
    this.#showValues();
    this.due();
  }

  // What a reader sees

  draw() {
    const { stage, q, size } = this;
    const classic = frames(this.arm, q);
    const tool = forward(this.arm, q);
    const arrow = 0.15 * size;
    const corners = this.#corners(classic, tool);
    this.#remember(origin(tool));

    stage.follow([...corners, ...classic.flatMap((pose) => [0, 2].map((k) => along(origin(pose), arrow, column(pose, k)))), along(origin(tool), arrow, column(tool, 2))], (1.1 * Math.min(stage.width, stage.height)) / size);
    stage.begin();
    const bodies = this.#bodies(classic, tool, corners);
    if (this.space) this.space.show(stage, bodies);
    else this.#drawFlat(bodies);
    this.#drawLink(classic);
    if (this.trace?.length > 1) stage.path("guides", "trace", this.trace.map((p) => stage.see(p)), "trace", { free: true });
    if (this.circling.box.checked) this.#drawCircle();
    this.#drawFrames(arrow);
    stage.end();

    this.marked ??= tool;
    this.matrix.show(tool, this.marked, (value, isLength) => entry(value, isLength ? this.digits : 3));
    for (const [name, table] of Object.entries(this.tables)) {
      table.show(this.arms[name].joints.map((joint, k) => parameters(joint, q[k])), { moved: this.moved, link: this.link });
    }
    this.#tell(tool);
  }

  /** Where the arm runs, from the ground to the tool. */
  #corners(classic, tool) {
    const corners = [[0, 0, 0], origin(classic[0])];
    this.arm.joints.forEach((joint, k) => {
      corners.push(along(origin(classic[k]), parameters(joint, this.q[k]).d, column(classic[k], 2)), origin(classic[k + 1]));
    });
    return [...corners, origin(tool)];
  }

  #bodies(classic, tool, corners) {
    const { size } = this;
    const bodies = [];
    const tube = (start, end, radius, colour, shape = "tube") => {
      if (length(subtract(end, start)) > 1e-6 * size) bodies.push({ shape, start, end, radius, colour });
    };
    tube([0, 0, -0.012 * size], [0, 0, 0], 0.09 * size, "body");
    corners.slice(1).forEach((corner, k) => {
      tube(corners[k], corner, 0.02 * size, "body");
      bodies.push({ shape: "ball", start: corner, end: corner, radius: 0.02 * size, colour: "body" });
    });
    this.arm.joints.forEach(({ kind, sign }, k) => {
      const z = column(classic[k], 2);
      const centre = along(origin(classic[k]), sign * this.heights[k], z);
      const colour = this.moved === k ? "accent" : "faint";
      tube(along(centre, -0.045 * size, z), along(centre, 0.045 * size, z), (kind === "R" ? 0.036 : 0.028) * size, colour, kind === "R" ? "tube" : "block");
    });
    const [p, approach, close] = [origin(tool), column(tool, 2), column(tool, 1)];
    for (const side of [-1, 1]) {
      const palm = along(along(p, -0.05 * size, approach), side * 0.03 * size, close);
      tube(along(p, -0.05 * size, approach), palm, 0.008 * size, "muted");
      tube(palm, along(palm, 0.05 * size, approach), 0.008 * size, "muted");
    }
    return bodies;
  }

  /** The bodies without three.js: the farther first. */
  #drawFlat(bodies) {
    const { stage } = this;
    const solid = bodies.filter(({ shape }) => shape !== "ball");
    const depth = ({ start, end }) => start.reduce((sum, value, k) => sum + (value + end[k]) * stage.toward[k], 0);
    for (const [k, body] of [...solid.entries()].sort(([, one], [, other]) => depth(one) - depth(other))) {
      const middle = body.start.map((value, i) => (value + body.end[i]) / 2);
      const way = subtract(body.end, body.start);
      const half = length(way) / 2;
      stage.cylinder(`body ${k}`, middle, way.map((value) => value / (2 * half)), body.radius, half, body.colour);
    }
  }

  #drawFrames(arrow) {
    const both = this.shown === "both";
    const arrows = [];
    for (const name of ["classic", "modified"]) {
      if (this.shown !== name && !both) continue;
      frames(this.arms[name], this.q).forEach((pose, i) => {
        this.stage.dot(`origin ${name} ${i}`, origin(pose));
        for (const [k, letter] of [[0, "x"], [2, "z"]]) {
          arrows.push({
            key: `${name} ${i} ${letter}`, start: origin(pose), direction: column(pose, k), size: both && name === "modified" ? 1.25 * arrow : arrow,
            letter, style: both && name === "modified" ? "dashed" : "", index: String(i), suffix: both ? name[0] : "",
          });
        }
      });
    }
    this.stage.arrows(arrows);
  }

  /** The two axes of a link, and the common normal between them. */
  #drawLink(classic) {
    if (this.link === null) return;
    const k = this.link;
    const n = this.arm.joints.length;
    for (const i of [k, k + 1].filter((number) => number >= 1 && number <= n)) {
      const [start, z] = [origin(classic[i - 1]), column(classic[i - 1], 2)];
      this.stage.line("far", `axis ${i}`, along(start, -0.5 * this.size, z), along(start, 0.5 * this.size, z), "axis marked");
      this.stage.label(`axis ${i} label`, `axis ${i}`, "marked", [{ at: this.stage.see(along(start, 0.5 * this.size, z)), toward: [0.6, -0.8], cost: 0 }]);
    }
    if (k >= 1 && Math.abs(this.arm.joints[k - 1].a) > 1e-9 * this.size) {
      const [end, x] = [origin(classic[k]), column(classic[k], 0)];
      this.stage.measure("normal", along(end, -this.arm.joints[k - 1].a, x), end, "marked", `a_${k}`);
    }
  }

  #drawCircle() {
    const { centre, axis, elbow, radius } = elbowCircle(this.arm, this.q);
    if (radius < 1e-6 * this.size) return;
    this.stage.circle("guides", "circle", centre, axis, radius, "circle");
    this.stage.line("guides", "circle radius", centre, elbow, "guide");
    this.stage.handle("elbow", elbow, "marked");
  }

  #remember(p) {
    const last = this.trace?.at(-1);
    if (!this.trace || (last && length(subtract(p, last)) < 1e-3 * this.size)) return;
    this.trace.push(p);
    if (this.trace.length > LONGEST_TRACE) this.trace.shift();
  }

  #tell(tool) {
    const { unit, joints } = this.arm;
    let words = `The tool is at ${point(origin(tool), this.digits)} ${unit}, and points along ${point(column(tool, 2))}.`;
    if (this.link !== null) {
      const k = this.link;
      const n = joints.length;
      const where = (name, row) => (row >= 1 && row <= n ? `row ${row} of the ${name} table` : `no row of the ${name} table, but in the ${row === 0 ? "base" : "tool"}`);
      words = `a_${k} and α_${k} of link ${k} stand in ${where("classic", k)}, and in ${where("modified", k + 1)}.`;
    }
    else if (this.turned) {
      words = `The elbow is at ψ = ${degrees(this.elbowAngle, 0)} of its circle; the tool rests at ${point(origin(tool), this.digits)} ${unit}.`;
      const { stopped } = this.turned;
      if (stopped !== null) words = `Joint ${stopped + 1} is at its limit, ${degrees(this.q[stopped], 0)}: the elbow goes no farther. The tool rests.`;
    }
    if (words === this.told) return;
    this.told = words;
    this.sentence.innerHTML = words.replace(/[aα]_\d/g, (symbol) => html(symbol));
    const values = this.q.map((value, k) => `q ${k + 1} ${joints[k].kind === "R" ? `${short(value / DEGREE, 0)}°` : `${short(value)} ${unit}`}`).join(", ");
    const heard = words.replaceAll("_", " ");
    this.say(`${heard} ${values}.`);
    this.picture.setAttribute("aria-label", `${this.arm.name}, ${this.shown === "none" ? "without frames" : `with its frames in ${this.shown === "both" ? "both conventions" : `the ${this.shown} convention`}`}. ${heard}`);
  }
}

customElements.define("dh-robot", DhRobot);

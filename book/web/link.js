// {dh-link}: two frames and the link between them, four parameters to drag, four steps to play.

import { LiveFigure, Matrix, Slider, choice } from "./figure.js";
import { make } from "./make.js";
import { IDENTITY, add, along, column, cross, dot, length, linkMatrix, origin, scale, steps, subtract } from "./kinematics.js";
import { Stage, hold, orbit } from "./stage.js";
import { DEGREE, degrees, entry, html, point, short } from "./words.js";

const ORDER = { classic: ["theta", "d", "a", "alpha"], modified: ["alpha", "a", "theta", "d"] };
const LETTER = { theta: "θ", d: "d", a: "a", alpha: "α" };
const WORD = { theta: "joint angle", d: "link offset", a: "link length", alpha: "link twist" };
const OF_LINK = ["a", "alpha"];
const DONE = 4;
/** Radius of an arc, for arrows of length 1. */
const ARC = 0.55;
/** The handle of an angle stands that much farther out. */
const OUT = 1.25;

class DhLink extends LiveFigure {
  build() {
    const given = (name) => Number(this.getAttribute(name));
    this.reach = given("reach");
    this.unit = this.getAttribute("unit");
    this.index = this.getAttribute("index");
    this.before = /^\d+$/.test(this.index) ? String(this.index - 1) : `${this.index}-1`;
    this.start = {
      convention: this.getAttribute("convention"),
      theta: given("theta"), d: given("d"), a: given("a"), alpha: given("alpha"),
    };
    this.state = { ...this.start };
    this.progress = DONE;
    this.reference = null;

    this.convention = choice({
      legend: "Convention", value: this.state.convention, options: [["classic", "classic"], ["modified", "modified"]],
      changed: (convention) => this.change({ convention }, true),
    });
    const share = make("button", { type: "button", click: () => this.share(this.state, share) }, "Copy link");
    const reset = make("button", { type: "button", click: () => this.reset() }, "Reset");

    this.picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    this.picture.setAttribute("role", "img");
    this.stage = new Stage(this.picture, () => this.due());
    this.ground = make("div", { class: "stage", tabindex: 0, role: "group", "aria-label": "Drawing. The arrow keys turn the view, Home turns it back." }, this.picture);
    orbit(this.ground, this.stage);
    hold(this.ground, this.stage, (name) => this.#grip(name));

    this.matrix = new Matrix("");
    this.sentence = make("p", { class: "sentence", "aria-hidden": "true" });
    this.chips = [0, 1, 2, 3].map((k) => make("button", { type: "button", class: "chip", click: () => this.play(k, k + 1) }));
    this.product = make("span");
    this.back = make("button", { type: "button", "aria-label": "One step back", click: () => this.stepTo(Math.max(0, Math.ceil(this.progress) - 1)) }, "◀");
    this.forth = make("button", { type: "button", "aria-label": "One step on", click: () => this.stepOn() }, "▶");
    this.playing = make("button", { type: "button", class: "main", click: () => this.playAll() }, "Play the steps");
    this.sliders = Object.fromEntries(ORDER.classic.map((name) => [name, this.#slider(name)]));
    this.rows = make("div", { class: "sliders" });

    this.live.classList.add("link");
    this.live.append(
      make("div", { class: "bar" }, this.convention.element, make("span", { class: "gap" }), reset, share),
      this.ground,
      make("div", { class: "steps", role: "group", "aria-label": "The four steps" },
        make("div", { class: "product" }, this.product, ...this.chips), make("div", { class: "play" }, this.back, this.forth, this.playing)),
      this.rows,
      make("div", { class: "beside" }, this.matrix.element, this.sentence),
    );
    this.#arrange();
    new ResizeObserver(([{ contentRect: { width, height } }]) => {
      if (!width) return;
      this.stage.resize(width, height);
      this.draw();
    }).observe(this.ground);
  }

  #slider(name) {
    const turns = OF_LINK[1] === name || name === "theta";
    const reach = turns ? 180 : this.reach;
    return new Slider({
      symbol: LETTER[name], word: WORD[name], style: OF_LINK.includes(name) ? "x" : "z",
      unit: turns ? "°" : this.unit, heard: turns ? "degrees" : this.unit || "units",
      low: -reach, high: reach, step: turns ? 1 : reach / 40, digits: turns ? 0 : 3, value: this.state[name],
      changed: (value, done) => this.change({ [name]: value }, done),
    });
  }

  /** The name of a parameter, its index as the convention has it. */
  symbol(name) {
    const index = this.state.convention === "modified" && OF_LINK.includes(name) ? this.before : this.index;
    return `${LETTER[name]}_{${index}}`;
  }

  /** Order and names that hang on the convention. */
  #arrange() {
    const order = ORDER[this.state.convention];
    this.convention.set(this.state.convention);
    for (const name of order) this.sliders[name].rename(this.symbol(name), WORD[name]);
    if (this.rows.dataset.order !== this.state.convention) {
      this.rows.replaceChildren(...order.map((name) => this.sliders[name].element));
      this.rows.dataset.order = this.state.convention;
    }
    this.#steps().forEach(({ parameter, axis, turns }, k) => {
      const heard = `, step ${k + 1}: ${turns ? "turn about" : "shift along"} ${axis} by the ${WORD[parameter]}`;
      this.chips[k].innerHTML = `${html(`${turns ? "R" : "T"}_${axis}(${this.symbol(parameter)})`)}<span class="heard">${heard}</span>`;
    });
    this.product.innerHTML = `${this.#name()} =`;
  }

  #name() {
    return `<sup>${html(this.before.replace("-", "−"))}</sup><i>A</i><sub>${html(this.index)}</sub>`;
  }

  #radians(factors = {}) {
    const { theta, d, a, alpha } = this.state;
    const values = { theta: theta * DEGREE, d, a, alpha: alpha * DEGREE };
    for (const [name, factor] of Object.entries(factors)) values[name] *= factor;
    return values;
  }

  #steps(factors) {
    return steps(this.state.convention, this.#radians(factors));
  }

  /** The matrix after some steps, the last of them perhaps in part. */
  #after(progress) {
    const factors = Object.fromEntries(ORDER[this.state.convention].map((name, k) => [name, Math.max(0, Math.min(1, progress - k))]));
    return linkMatrix(this.state.convention, this.#radians(factors));
  }

  // What a reader does

  change(values, done) {
    this.halt();
    this.reference ??= this.#after(this.progress);
    this.marked = this.reference;
    Object.assign(this.state, values);
    if (values.convention) this.#arrange();
    if (done) {
      this.reference = null;
      this.#settle();
    }
    this.due();
  }

  reset() {
    this.progress = DONE;
    this.stage.turn();
    this.change({ ...this.start }, true);
    this.#showValues();
  }

  read(address) {
    const values = {};
    if (Object.hasOwn(ORDER, address.get("convention"))) values.convention = address.get("convention");
    for (const name of ORDER.classic) {
      const value = address.get(name) === null ? NaN : Number(address.get(name));
      const { low, high } = this.sliders[name];
      if (Number.isFinite(value)) values[name] = Math.max(low, Math.min(high, value));
    }
    this.change(values, true);
    this.#showValues();
  }

  // What the cells of the page see and change

  get forCells() {
    return { kind: "link", ...this.state, reach: this.reach };
  }

  take(values) {
    this.progress = DONE;
    this.change(values, true);
    this.#showValues();
  }

  #showValues() {
    for (const name of ORDER.classic) this.sliders[name].set(this.state[name]);
  }

  /** Play from one step to a later one, then perhaps onwards. */
  play(from, to, then = () => {}) {
    this.halt();
    this.progress = from;
    this.marked = this.#after(from);
    this.move(900, (part) => {
      this.progress = from + part * (to - from);
      this.draw();
    }, () => {
      this.progress = to;
      this.draw();
      then();
    });
  }

  playAll() {
    this.#playOn(this.progress >= DONE ? 0 : Math.floor(this.progress));
  }

  #playOn(from) {
    this.play(from, from + 1, () => {
      if (from + 1 < DONE) this.wait = setTimeout(() => this.#playOn(from + 1), this.still ? 1400 : 450);
    });
  }

  stepOn() {
    const from = this.progress >= DONE ? 0 : Math.floor(this.progress);
    this.play(from, from + 1);
  }

  stepTo(progress) {
    this.halt();
    this.marked = this.#after(Math.max(0, progress - 1));
    this.progress = progress;
    this.due();
  }

  // What a reader sees

  #closest() {
    return (0.6 * Math.min(this.stage.width, 1.3 * this.stage.height)) / this.reach;
  }

  #room() {
    const goal = this.#after(DONE);
    const size = 0.5 * this.reach;
    const tips = [IDENTITY, goal].flatMap((pose) => [0, 1, 2].map((k) => along(origin(pose), size, column(pose, k))));
    const [, one, two, three] = [0, 1, 2, 3].map((k) => origin(this.#after(k)));
    return [...tips, [0, 0, 0], one, two, three, origin(goal), [0, 0, -0.3 * size]];
  }

  /** Let the camera come nearer once the hand rests. */
  #settle() {
    if (!this.stage.camera) return;
    const from = this.stage.camera;
    const to = this.stage.fitting(this.#room(), this.#closest());
    if (Math.hypot(to.x - from.x, to.y - from.y) * to.zoom < 0.06 * this.stage.width && to.zoom < 1.12 * from.zoom) return;
    this.move(450, (part) => {
      const mix = (name) => from[name] + part * (to[name] - from[name]);
      this.stage.camera = { x: mix("x"), y: mix("y"), zoom: mix("zoom") };
      this.draw();
    });
  }

  draw() {
    const { stage, progress } = this;
    const list = this.#steps();
    const stations = [0, 1, 2, 3, 4].map((k) => this.#after(k));
    const goal = stations[DONE];
    const size = 0.5 * this.reach;
    const partial = progress < DONE;

    stage.follow(this.#room(), this.#closest());
    stage.begin();
    this.#drawAxes(stations, size);
    this.#drawBody(stations, size);
    stage.frame("before", IDENTITY, size, "dashed", this.before);
    stage.frame("after", goal, size, partial ? "faint" : "", this.index);
    if (partial) stage.frame("ghost", this.#after(progress), 0.8 * size, "ghost", "");
    list.forEach((step, k) => this.#drawStep(step, k, stations, size, Math.max(0, Math.min(1, progress - k))));
    stage.end();

    const shown = this.#after(progress);
    this.marked ??= shown;
    const digits = this.reach >= 20 ? 1 : 3;
    this.matrix.show(shown, this.marked, (value, isLength) => entry(value, isLength ? digits : 3));
    const name = partial ? this.#productSoFar(list) : this.#name();
    if (this.matrix.named !== name) this.matrix.title.innerHTML = this.matrix.named = name;
    this.chips.forEach((chip, k) => {
      chip.classList.toggle("done", k + 1 <= progress);
      if (partial && k === Math.max(0, Math.ceil(progress) - 1) && progress > 0) chip.setAttribute("aria-current", "step");
      else chip.removeAttribute("aria-current");
    });
    this.#tell(list, goal);
  }

  #productSoFar(list) {
    const count = Math.ceil(this.progress);
    if (count === 0) return "<b>1</b> (no step yet)";
    return list.slice(0, count).map(({ parameter, axis, turns }) => html(`${turns ? "R" : "T"}_${axis}(${this.symbol(parameter)})`)).join(" ");
  }

  /** The two z axes as long lines, beyond all that is measured along them. */
  #drawAxes(stations, size) {
    for (const [key, pose] of [["axis before", IDENTITY], ["axis after", stations[DONE]]]) {
      const [start, z] = [origin(pose), column(pose, 2)];
      const reached = stations.map((other) => subtract(origin(other), start))
        .filter((way) => length(cross(way, z)) < 1e-9 * this.reach)
        .map((way) => dot(way, z));
      this.stage.line("far", key, along(start, Math.min(...reached) - 0.55 * size, z), along(start, Math.max(size, ...reached) + 0.45 * size, z), "axis");
    }
  }

  #drawBody(stations, size) {
    const seen = stations.map((pose) => this.stage.see(origin(pose)));
    this.stage.path("body", "rim", seen, "rim", { free: true });
    this.stage.path("body", "flesh", seen, "flesh", { free: true });
    this.stage.cylinder("joint before", [0, 0, 0], [0, 0, 1], 0.13 * size, 0.2 * size);
    this.stage.cylinder("joint after", origin(stations[DONE]), column(stations[DONE], 2), 0.13 * size, 0.2 * size);
  }

  /** The segment or the angle of a step, as far as it has been done; and thin lines where an angle needs legs. */
  #drawStep({ parameter, axis, turns }, k, stations, size, part) {
    const value = this.#radians()[parameter] * part;
    const symbol = this.symbol(parameter);
    const [from, to] = [stations[k], stations[k + 1]];
    const direction = column(from, axis === "z" ? 2 : 0);
    const style = axis;
    if (part === 1) this.stage.handle(parameter, turns ? this.#onCircle(k, stations, value) : along(origin(from), value, direction), style);
    if (!turns) {
      if (Math.abs(value) > 1e-9 * this.reach) this.stage.measure(parameter, origin(from), along(origin(from), value, direction), style, symbol);
      return;
    }
    if (Math.abs(value) < DEGREE) return;
    const leg = axis === "z" ? 0 : 2;
    const radius = ARC * size;
    const guide = (key, pose) => this.stage.line("guides", `${parameter} ${key}`, origin(pose), along(origin(pose), OUT * radius, column(pose, leg)), "guide");
    if (k > 0) guide("from", from);
    if (k < 3 && part === 1) guide("to", to);
    this.stage.arc(parameter, origin(from), direction, column(from, leg), value, radius, style, symbol);
  }

  /** Where the leg of an angle, turned by so much, meets the arc: there its handle is. */
  #onCircle(k, stations, angle) {
    const { axis } = this.#steps()[k];
    const pose = stations[k];
    const [first, second] = axis === "z" ? [column(pose, 0), column(pose, 1)] : [column(pose, 2), scale(-1, column(pose, 1))];
    return add(origin(pose), scale(0.5 * this.reach * ARC * OUT, add(scale(Math.cos(angle), first), scale(Math.sin(angle), second))));
  }

  /** How the handle of a parameter moves. */
  #grip(name) {
    const k = ORDER[this.state.convention].indexOf(name);
    const stations = [0, 1, 2, 3, 4].map((count) => this.#after(count));
    const slider = this.sliders[name];
    const turns = name === "theta" || name === "alpha";
    return {
      value: this.#radians()[name],
      along: turns ? null : column(stations[k], OF_LINK.includes(name) ? 0 : 2),
      around: (angle) => this.#onCircle(k, stations, angle),
      changed: (value, done) => slider.move(turns ? value / DEGREE : value, done),
    };
  }

  /** The state in words. */
  #tell(list, goal) {
    const { theta, d, a, alpha } = this.state;
    const [before, after] = [`z_{${this.before}}`, `z_{${this.index}}`];
    const measure = (value) => short(value, 2) + (this.unit && ` ${this.unit}`);
    let words;
    if (this.progress < DONE) {
      const whole = this.progress % 1 === 0;
      const k = Math.ceil(this.progress) - 1;
      if (k < 0) words = `Start: the moving frame lies on frame ${this.before}.`;
      else {
        const { parameter, axis, turns } = list[k];
        const value = this.state[parameter];
        words = `Step ${k + 1} of 4: ${turns ? `turn about ${axis} by ${this.symbol(parameter)} = ${short(value, 1)}°` : `shift along ${axis} by ${this.symbol(parameter)} = ${measure(value)}`}${whole ? ". Done" : ""}.`;
      }
    } else {
      const parallel = Math.abs(Math.sin(alpha * DEGREE)) < 1e-9;
      const sense = Math.cos(alpha * DEGREE) < 0 ? " and point opposite ways" : "";
      if (a === 0 && parallel) words = `The axes ${before} and ${after} lie on one line${sense}.`;
      else if (parallel) words = `The axes ${before} and ${after} are parallel${sense}, ${measure(Math.abs(a))} apart.`;
      else if (a === 0) words = `The axes ${before} and ${after} meet, at an angle of ${degrees(alpha * DEGREE)}.`;
      else words = `The axes ${before} and ${after} are skew: ${measure(Math.abs(a))} apart, twisted by ${degrees(alpha * DEGREE)}.`;
      words += ` The origin of frame ${this.index} is at ${point(origin(goal))}${this.unit && ` ${this.unit}`}.`;
    }
    if (words === this.told) return;
    this.told = words;
    this.sentence.innerHTML = words.replace(/[a-zα-ω]_(\{[^}]*\}|.)/g, (symbol) => html(symbol)).replace(/frame (i-1|i)\b/g, (_, index) => `frame {${html(index.replace("-", "−"))}}`);
    const heard = words.replace(/_\{([^}]*)\}/g, " $1").replace(/i-1/g, "i minus 1");
    const conventional = `${this.state.convention} convention, θ ${short(theta, 1)}°, d ${measure(d)}, a ${measure(a)}, α ${short(alpha, 1)}°. `;
    this.say((this.progress < DONE ? "" : conventional) + heard);
    this.picture.setAttribute("aria-label", `Frame ${this.before}, dashed, frame ${this.index} and the link between them. ${heard}`.replace("i-1", "i minus 1"));
  }
}

customElements.define("dh-link", DhLink);

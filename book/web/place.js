// {dh-place}: joint axes in space, and frames for the reader to place. Any choice that obeys DH1 and DH2 is right.

import { LiveFigure, Slider, choice } from "./figure.js";
import { make } from "./make.js";
import {
  add, along, axes, chainOfFrames, column, commonNormal, cross, deviation, disagreement, dot, foot, forward, frame, origin, readParameters, scale, subtract, unit,
} from "./kinematics.js";
import { Stage, hold, orbit } from "./stage.js";
import { Table } from "./table.js";
import { DEGREE, degrees, html, short } from "./words.js";

const TOLERANCE = 1e-6;
/** What a slider jumps to is as far as half a step away; what is typed must be this near, in parts of a step. */
const TYPED = 0.1;
const ANGLE_STEP = 5;

class DhPlace extends LiveFigure {
  build() {
    const data = (name) => JSON.parse(this.getAttribute(name));
    this.chain = data("chain");
    this.heights = data("heights");
    this.size = data("size");
    this.step = this.size / 40;
    this.digits = this.size > 20 ? 1 : 3;
    this.lines = axes(this.chain);
    this.n = this.lines.length;
    this.classic = this.chain.convention === "classic";
    this.carriers = this.#carriers();
    this.placed = this.#startingPlaces();
    this.chosen = 0;

    const reset = make("button", { type: "button", click: () => this.reset() }, "Reset");
    this.picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    this.picture.setAttribute("role", "img");
    this.stage = new Stage(this.picture, () => this.due());
    this.ground = make("div", { class: "stage", tabindex: 0, role: "group", "aria-label": "Joint axes and frames. The arrow keys turn the view, Home turns it back." }, this.picture);
    orbit(this.ground, this.stage);
    hold(this.ground, this.stage, (key) => this.#grip(key));

    this.frames = choice({
      legend: "Frame to place", value: "0", options: this.placed.map((_, i) => [String(i), `{${i}}`]),
      changed: (i) => { this.chosen = Number(i); this.#arrange(); this.due(); },
    });
    this.over = make("button", { type: "button", "aria-pressed": "false", click: () => this.#turnOver() });
    this.sliders = {
      s: new Slider({ symbol: "O_0", word: "along z", style: "z", unit: this.chain.unit, heard: this.chain.unit, low: -this.size, high: this.size, step: this.step, digits: 4, value: 0, changed: (value, done) => this.#move("s", value, done) }),
      phi: new Slider({ symbol: "x_0", word: "about z", style: "x", unit: "°", heard: "degrees", low: -180, high: 180, step: ANGLE_STEP, digits: 2, value: 0, changed: (value, done) => this.#move("phi", value, done) }),
    };
    this.checks = this.lines.map(() => ({ dh1: make("td"), dh2: make("td") }));
    this.sentence = make("p", { class: "sentence", "aria-hidden": "true" });
    this.table = new Table(this.chain.convention, this.lines.map(({ kind }) => kind));
    this.live.classList.add("place");
    this.live.append(
      make("div", { class: "bar" }, make("div", { class: "choose" }, "Place", this.frames.element, this.over), make("span", { class: "gap" }), reset),
      this.ground,
      make("div", { class: "sliders" }, this.sliders.s.element, this.sliders.phi.element),
      make("div", { class: "beside" },
        make("table", { class: "checks" }, make("caption", { class: "heard" }, "What the frames obey"),
          make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "link"), make("th", { scope: "col" }, "DH1"), make("th", { scope: "col" }, "DH2"))),
          make("tbody", {}, ...this.checks.map(({ dh1, dh2 }, k) => make("tr", {}, make("th", { scope: "row" }, String(k + 1)), dh1, dh2)))),
        this.sentence),
      make("div", { class: "tables" }, this.table.element),
    );
    this.#arrange();
    new ResizeObserver(([{ contentRect: { width, height } }]) => {
      if (!width) return;
      this.stage.resize(width, height);
      this.draw();
    }).observe(this.ground);
  }

  // The lines on which frames 0 to n may stand: the joint axes, and the line of the tool or of the base.

  #carriers() {
    const line = (pose) => ({ point: origin(pose), direction: column(pose, 2) });
    const listed = this.classic ? [...this.lines, line(forward(this.chain, this.lines.map(() => 0)))] : [line(this.chain.base), ...this.lines];
    const heart = scale(1 / listed.length, listed.reduce((sum, { point }) => add(sum, point), [0, 0, 0]));
    return listed.map(({ point, direction }, i) => {
      const away = [[1, 0, 0], [0, 1, 0]].find((axis) => Math.abs(dot(axis, direction)) < 0.8);
      const reference = unit(along(away, -dot(away, direction), direction));
      const carrier = { point: foot({ point, direction }, heart), direction, reference };
      const neighbours = [listed[i - 1], listed[i + 1]].filter(Boolean);
      return { ...carrier, ...this.#landmarks(carrier, neighbours) };
    });
  }

  /** Where sliders stop by themselves: the feet of the common normals with the neighbours, and their directions. */
  #landmarks({ point, direction, reference }, neighbours) {
    const s = [0];
    const phi = [0, 90, 180, -90];
    const side = cross(direction, reference);
    for (const neighbour of neighbours) {
      const normal = commonNormal({ point, direction }, neighbour);
      s.push(dot(subtract(normal.before, point), direction));
      s.push(dot(subtract(neighbour.point, point), direction));
      if (!normal.x) continue;
      const angle = Math.atan2(dot(normal.x, side), dot(normal.x, reference)) / DEGREE;
      phi.push(angle, angle > 0 ? angle - 180 : angle + 180);
    }
    return { landmarks: { s, phi } };
  }

  /** Somewhere on their lines, and not yet right. */
  #startingPlaces() {
    return this.carriers.map((_, i) => ({ sense: 1, s: this.step * (i % 2 ? 9 : -7), phi: [30, -60, 135, -25, 70][i % 5] }));
  }

  /** The pose of a placed frame. */
  #pose(i) {
    const { point, direction, reference } = this.carriers[i];
    const { sense, s, phi } = this.placed[i];
    const side = cross(direction, reference);
    const x = add(scale(Math.cos(phi * DEGREE), reference), scale(Math.sin(phi * DEGREE), side));
    return frame(scale(sense, direction), x, along(point, s, direction));
  }

  // What a reader does

  #move(name, value, done) {
    const slider = this.sliders[name];
    const step = name === "s" ? this.step : ANGLE_STEP;
    const typed = this.shadowRoot.activeElement === slider.field;
    const near = (typed ? TYPED : 0.5) * step;
    const landmark = this.carriers[this.chosen].landmarks[name].find((mark) => Math.abs(mark - value) <= near);
    this.placed[this.chosen][name] = landmark ?? value;
    if (!typed || done) slider.set(landmark ?? value);
    this.due();
  }

  #turnOver() {
    this.placed[this.chosen].sense *= -1;
    this.#arrange();
    this.due();
  }

  #grip(key) {
    const [name, number] = key.split(" ");
    const i = Number(number);
    if (i !== this.chosen) {
      this.chosen = i;
      this.#arrange();
    }
    const { point, direction, reference } = this.carriers[i];
    const side = cross(direction, reference);
    const { s, phi } = this.placed[i];
    return name === "s"
      ? { value: s, along: direction, changed: (value, done) => this.sliders.s.move(value, done) }
      : {
        value: phi * DEGREE,
        around: (angle) => along(point, s, direction).map((value, k) => value + 0.8 * this.#arrow() * (Math.cos(angle) * reference[k] + Math.sin(angle) * side[k])),
        changed: (value, done) => this.sliders.phi.move(value / DEGREE, done),
      };
  }

  reset() {
    this.placed = this.#startingPlaces();
    this.chosen = 0;
    this.stage.turn();
    this.stage.camera = null;
    this.#arrange();
    this.due();
  }

  read() {}

  #arrange() {
    const i = this.chosen;
    const { sense, s, phi } = this.placed[i];
    this.frames.set(String(i));
    this.sliders.s.rename(`O_${i}`, "along the axis");
    this.sliders.phi.rename(`x_${i}`, "about the axis");
    this.sliders.s.set(s);
    this.sliders.phi.set(phi);
    this.over.innerHTML = `Turn ${html(`z_${i}`)} over`;
    this.over.setAttribute("aria-pressed", String(sense < 0));
  }

  // What a reader sees

  #arrow() {
    return 0.2 * this.size;
  }

  draw() {
    const { stage, size } = this;
    const poses = this.carriers.map((_, i) => this.#pose(i));
    const joints = this.lines.map(({ point, direction }, k) => along(point, this.heights[k], direction));
    stage.follow([...joints, ...poses.flatMap((pose) => [origin(pose), along(origin(pose), this.#arrow(), column(pose, 2)), along(origin(pose), this.#arrow(), column(pose, 0))])], (0.95 * Math.min(stage.width, stage.height)) / size);
    stage.begin();
    this.carriers.forEach(({ point, direction }, i) => {
      const number = this.classic ? i + 1 : i;
      const isJoint = number >= 1 && number <= this.n;
      const reach = [origin(poses[i]), isJoint ? joints[number - 1] : point].map((p) => dot(subtract(p, point), direction));
      const end = along(point, Math.max(...reach) + 0.3 * size, direction);
      stage.line("far", `axis ${i}`, along(point, Math.min(...reach) - 0.25 * size, direction), end, isJoint ? "axis" : "guide");
      stage.label(`axis ${i} name`, isJoint ? `${number}` : this.classic ? "tool" : "base", "quiet", [[0.7, -0.7], [-0.7, -0.7], [0.7, 0.7], [-0.7, 0.7]].map((toward, k) => ({ at: stage.see(end), toward, gap: 2, cost: k })));
    });
    joints.forEach((centre, k) => stage.cylinder(`joint ${k}`, centre, this.lines[k].direction, 0.034 * size, 0.045 * size));
    const arrows = poses.flatMap((pose, i) => ["x", "y", "z"].filter((letter) => letter !== "y" || i === this.chosen).map((letter) => ({
      key: `${i} ${letter}`, start: origin(pose), direction: column(pose, "xyz".indexOf(letter)), size: this.#arrow(), letter, index: String(i), style: i === this.chosen ? "chosen" : "dull",
    })));
    stage.arrows(arrows.sort((one, other) => (one.style === "chosen") - (other.style === "chosen")));
    poses.forEach((pose, i) => {
      stage.handle(`s ${i}`, origin(pose), i === this.chosen ? "marked" : "");
      if (i === this.chosen) stage.handle(`phi ${i}`, along(origin(pose), 0.8 * this.#arrow(), column(pose, 0)), "x");
    });
    stage.end();
    this.#judge(poses);
  }

  /** Say of each link what holds, and at the end whether the table moves like the arm. */
  #judge(poses) {
    const { convention, unit: length } = this.chain;
    const rows = [];
    const faults = [];
    this.checks.forEach(({ dh1, dh2 }, k) => {
      const { angle, distance } = deviation(poses[k], poses[k + 1], convention);
      const [one, two] = [angle < TOLERANCE, distance < TOLERANCE * this.size];
      const [x, z] = this.classic ? [k + 1, k] : [k, k + 1];
      mark(dh1, one, degrees(angle, 1));
      mark(dh2, two, `${short(distance, this.digits)} ${length}`);
      if (!one) faults.push(`DH1 fails at link ${k + 1}: x_${x} is ${degrees(angle, 1)} off the perpendicular to z_${z}.`);
      else if (!two) faults.push(`DH2 fails at link ${k + 1}: x_${x} passes z_${z} at a distance of ${short(distance, this.digits)} ${length}.`);
      rows.push(one && two ? readParameters(poses[k], poses[k + 1], convention) : null);
    });
    this.table.show(rows);
    let words = faults[0];
    const whole = faults.length === 0;
    if (whole) {
      const chain = chainOfFrames(poses, this.lines, convention);
      const off = disagreement(chain, this.lines, poses.at(-1));
      words = off < TOLERANCE * this.size
        ? "DH1 and DH2 hold at every link. With this table the arm moves as its axes say: your choice is right."
        : `DH1 and DH2 hold, but with this table the arm would move differently: by ${short(off, this.digits)} ${length}.`;
    }
    this.live.classList.toggle("whole", whole);
    if (words === this.told) return;
    this.told = words;
    const count = faults.length;
    this.sentence.innerHTML = words.replace(/[xz]_\d/g, (symbol) => html(symbol));
    this.say(words.replaceAll("_", " "));
    this.picture.setAttribute("aria-label", `${this.n} joint axes, with frames 0 to ${this.n} on them. ${count ? `${count} of ${this.n} links fail. ` : ""}${words.replaceAll("_", " ")}`);
  }
}

function mark(cell, holds, by) {
  const text = holds ? "✓ holds" : `✗ by ${by}`;
  if (cell.textContent === text) return;
  cell.textContent = text;
  cell.className = holds ? "right" : "wrong";
}

customElements.define("dh-place", DhPlace);

// A drawing in space that is kept and changed, not drawn anew: SVG in a parallel projection, seen from any side.
//
// Each picture is told piece by piece between begin() and end(). A piece keeps its element from picture to picture,
// labels look for a free place near their own, and the camera moves only when it must.

import { add, along, cross, dot, length, scale, subtract, unit } from "./kinematics.js";
import { DEGREE, pieces } from "./words.js";

const SVG = "http://www.w3.org/2000/svg";
const LAYERS = ["far", "body", "guides", "measures", "frames", "handles", "labels"];
const HOME = { azimuth: -52, elevation: 24 };
const FONT = 16;
const END_ON = 7;
const MARGIN = 30;

export class Stage {
  /** `svg` is filled; `changed` is called when the reader turned the view and the picture is due. */
  constructor(svg, changed) {
    this.svg = svg;
    this.changed = changed;
    this.pieces = new Map();
    this.choices = new Map();
    this.view = { ...HOME };
    this.camera = null;
    this.width = 640;
    this.height = 400;
    this.layers = Object.fromEntries(LAYERS.map((name) => [name, svg.appendChild(document.createElementNS(SVG, "g"))]));
    this.#aim();
  }

  // The eye

  #aim() {
    const [azimuth, elevation] = [this.view.azimuth * DEGREE, this.view.elevation * DEGREE];
    const [ca, sa, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation), Math.sin(elevation)];
    this.right = [-sa, ca, 0];
    this.down = [se * ca, se * sa, -ce];
    this.toward = [ce * ca, ce * sa, se];
  }

  resize(width, height) {
    this.width = width;
    this.height = height;
    this.camera = null;
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  }

  /** Turn the view by degrees; without numbers, back to where it was at first. */
  turn(azimuth, elevation) {
    this.view = azimuth === undefined
      ? { ...HOME }
      : { azimuth: this.view.azimuth + azimuth, elevation: Math.max(-85, Math.min(85, this.view.elevation + elevation)) };
    this.#aim();
    this.changed();
  }

  /** Where a point is seen, in pixels. */
  see(p) {
    const { x, y, zoom } = this.camera;
    return [this.width / 2 + zoom * (dot(this.right, p) - x), this.height / 2 + zoom * (dot(this.down, p) - y)];
  }

  /** How a direction is seen, in pixels for each unit of length. */
  seeDirection(v) {
    return [this.camera.zoom * dot(this.right, v), this.camera.zoom * dot(this.down, v)];
  }

  /** The camera that has all points in the picture and is not nearer than `closest`, in pixels for each unit. */
  fitting(points, closest) {
    const flat = points.map((p) => [dot(this.right, p), dot(this.down, p)]);
    const [left, top] = [0, 1].map((k) => Math.min(...flat.map((p) => p[k])));
    const [far, bottom] = [0, 1].map((k) => Math.max(...flat.map((p) => p[k])));
    const zoom = Math.min(closest, (this.width - 2 * MARGIN) / (far - left), (this.height - 2 * MARGIN) / (bottom - top));
    return { x: (left + far) / 2, y: (top + bottom) / 2, zoom, box: [left, top, far, bottom] };
  }

  /** Keep points in the picture: the camera follows what would leave it, and otherwise rests. */
  follow(points, closest) {
    const wanted = this.fitting(points, closest);
    if (!this.camera) this.camera = wanted;
    const zoom = Math.min(this.camera.zoom, wanted.zoom);
    const [left, top, far, bottom] = wanted.box;
    const [wide, high] = [(this.width / 2 - MARGIN) / zoom, (this.height / 2 - MARGIN) / zoom];
    const within = (value, low, top_) => Math.max(low, Math.min(top_, value));
    this.camera = { zoom, x: within(this.camera.x, far - wide, left + wide), y: within(this.camera.y, bottom - high, top + high) };
    return wanted;
  }

  // The picture

  begin() {
    this.used = new Set();
    this.labels = [];
    this.obstacles = [];
  }

  end() {
    this.#placeLabels();
    for (const [key, element] of this.pieces) {
      if (!this.used.has(key)) {
        element.remove();
        this.pieces.delete(key);
        this.choices.delete(key);
      }
    }
  }

  /** An element of the picture, kept under its key. */
  piece(layer, key, tag, attributes) {
    let element = this.pieces.get(key);
    if (!element) {
      element = this.layers[layer].appendChild(document.createElementNS(SVG, tag));
      element.kept = {};
      this.pieces.set(key, element);
    }
    this.used.add(key);
    for (const [name, value] of Object.entries(attributes)) {
      if (element.kept[name] !== value) element.setAttribute(name, (element.kept[name] = value));
    }
    return element;
  }

  /** A polyline through points seen, in pixels. */
  path(layer, key, points, style, { closed = false, free = false } = {}) {
    this.piece(layer, key, "path", { class: style, d: `M${points.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}${closed ? "Z" : ""}` });
    if (!free) for (let k = 1; k < points.length; k++) this.obstacles.push([points[k - 1], points[k]]);
  }

  line(layer, key, start, end, style, options) {
    this.path(layer, key, [this.see(start), this.see(end)], style, options);
  }

  /** A measured length, with its letter beside the middle. */
  measure(key, start, end, style, text) {
    const ends = [this.see(start), this.see(end)];
    this.path("measures", key, ends, `measure ${style}`);
    if (text) this.label(`${key} label`, text, style, beside(...ends));
  }

  /** An arrow with its letter at the tip; one that is seen end on becomes a dot in a ring, or a cross. */
  arrow(key, start, end, style, text, aside = 0) {
    const [tail, tip] = [this.see(start), this.see(end)];
    const [dx, dy] = [tip[0] - tail[0], tip[1] - tail[1]];
    const seen = Math.hypot(dx, dy);
    if (aside && seen > END_ON) {
      for (const end_ of [tail, tip]) {
        end_[0] -= (aside * dy) / seen;
        end_[1] += (aside * dx) / seen;
      }
    }
    if (seen < END_ON) {
      const cross_ = dot(this.toward, subtract(end, start)) > 0 ? "" : "M-3.2-3.2 3.2 3.2M-3.2 3.2 3.2-3.2";
      this.piece("frames", `${key} ring`, "path", {
        class: `ring ${style}`,
        d: `M-6 0a6 6 0 1 0 12 0a6 6 0 1 0-12 0${cross_ || "M-1.5 0a1.5 1.5 0 1 0 3 0a1.5 1.5 0 1 0-3 0"}`,
        transform: `translate(${tail.map((value) => value.toFixed(1))})`,
      });
      if (text) this.label(`${key} label`, text, style, around(tail, [0.7, 0.7], 8));
      return;
    }
    const [ux, uy] = [dx / seen, dy / seen];
    const [size, half] = [Math.min(11, 0.6 * seen), Math.min(4.3, 0.24 * seen)];
    const neck = [tip[0] - size * ux, tip[1] - size * uy];
    this.path("frames", `${key} casing`, [tail, tip], `casing ${style}`, { free: true });
    this.path("frames", key, [tail, [tip[0] - 0.8 * size * ux, tip[1] - 0.8 * size * uy]], `arrow ${style}`);
    this.path("frames", `${key} head`, [tip, [neck[0] - half * uy, neck[1] + half * ux], [neck[0] + half * uy, neck[1] - half * ux]], `head ${style}`, { closed: true, free: true });
    if (text) this.label(`${key} label`, text, style, around(tip, [ux, uy]));
  }

  /** Arrows of several frames: those that coincide are drawn once, with all their indices; of different letters, side by side. */
  arrows(listed) {
    const groups = [];
    for (const arrow of listed) {
      const same = ([other]) => length(subtract(other.start, arrow.start)) < 1e-6 * arrow.size && length(subtract(other.direction, arrow.direction)) < 1e-6;
      const group = groups.find(same);
      if (group) group.push(arrow);
      else groups.push([arrow]);
    }
    for (const group of groups) {
      const letters = [...new Set(group.map(({ letter }) => letter))];
      letters.forEach((letter, k) => {
        const mine = group.filter((arrow) => arrow.letter === letter);
        const [{ key, start, direction, style }] = mine;
        const size = Math.max(...mine.map((arrow) => arrow.size));
        this.arrow(key, start, along(start, size, direction), `${letter} ${style}`, `${letter}_{${indices(mine)}}`, 4 * (k - (letters.length - 1) / 2));
      });
    }
  }

  /** A dot at a point. */
  dot(key, p, style = "") {
    const [cx, cy] = this.see(p).map((value) => value.toFixed(1));
    this.piece("frames", key, "circle", { class: `origin ${style}`, cx, cy, r: 3.4 });
  }

  /** A whole circle in space. */
  circle(layer, key, centre, axis, radius, style) {
    const first = unit(cross(axis, Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    const second = cross(axis, first);
    const points = Array.from({ length: 72 }, (_, k) => {
      const turned = (k * Math.PI) / 36;
      return this.see(add(centre, add(scale(radius * Math.cos(turned), first), scale(radius * Math.sin(turned), second))));
    });
    this.path(layer, key, points, style, { closed: true, free: true });
  }

  /** A frame: arrows x, y, z with their letters. */
  frame(key, pose, size, style, index) {
    const start = pose.slice(0, 3).map((row) => row[3]);
    ["x", "y", "z"].forEach((letter, k) => {
      const direction = pose.slice(0, 3).map((row) => row[k]);
      this.arrow(`${key} ${letter}`, start, along(start, size, direction), `${letter} ${style}`, index && `${letter}_{${index}}`);
    });
    this.dot(`${key} origin`, start, style);
  }

  /** An angle, from the direction `from` about `axis`: a wedge, an arc with a head, and its letter. */
  arc(key, centre, axis, from, angle, radius, style, text) {
    const side = cross(axis, from);
    const at = (turned, r = radius) => add(centre, add(scale(r * Math.cos(turned), from), scale(r * Math.sin(turned), side)));
    const count = Math.max(2, Math.ceil(Math.abs(angle) / (5 * DEGREE)));
    const points = Array.from({ length: count + 1 }, (_, k) => this.see(at((angle * k) / count)));
    this.path("guides", `${key} wedge`, [this.see(centre), ...points], `wedge ${style}`, { closed: true, free: true });
    this.path("measures", key, points, `arc ${style}`);
    const tip = points.at(-1);
    const before = this.see(at(angle - Math.sign(angle) * Math.min(Math.abs(angle), 9 * DEGREE)));
    const [dx, dy] = [tip[0] - before[0], tip[1] - before[1]];
    const seen = Math.hypot(dx, dy) || 1;
    const [ux, uy, size, half] = [dx / seen, dy / seen, 9, 3.6];
    this.path("measures", `${key} head`, [tip, [tip[0] - size * ux - half * uy, tip[1] - size * uy + half * ux], [tip[0] - size * ux + half * uy, tip[1] - size * uy - half * ux]], `head ${style}`, { closed: true, free: true });
    if (text) {
      const heart = this.see(centre);
      const places = [0.5, 0.35, 0.65, 0.2, 0.8].flatMap((part) => {
        const [x, y] = this.see(at(angle * part));
        const away = Math.hypot(x - heart[0], y - heart[1]) || 1;
        return around([x, y], [(x - heart[0]) / away, (y - heart[1]) / away]).slice(0, 5).map((place) => ({ ...place, cost: place.cost + 10 * Math.abs(part - 0.5) }));
      });
      this.label(`${key} label`, text, style, places);
    }
  }

  /** A joint: a cylinder about an axis, its nearer cap on top. */
  cylinder(key, centre, axis, radius, half, style = "") {
    const first = unit(cross(axis, Math.abs(axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
    const second = cross(axis, first);
    const circle = (at) => Array.from({ length: 32 }, (_, k) => {
      const turned = (k * Math.PI) / 16;
      return this.see(add(at, add(scale(radius * Math.cos(turned), first), scale(radius * Math.sin(turned), second))));
    });
    const sense = dot(axis, this.toward) > 0 ? half : -half;
    const [near, far] = [circle(along(centre, sense, axis)), circle(along(centre, -sense, axis))];
    this.path("body", `${key} side`, hull([...near, ...far]), `cylinder ${style}`, { closed: true, free: true });
    this.path("body", `${key} cap`, near, `cap ${style}`, { closed: true, free: true });
  }

  /** A place to take hold of; `grips` says what is moved there. */
  handle(key, p, style) {
    const [cx, cy] = this.see(p).map((value) => value.toFixed(1));
    this.piece("handles", `${key} knob`, "circle", { class: `knob ${style}`, cx, cy, r: 5.5 });
    this.piece("handles", `${key} grip`, "circle", { class: "grip", cx, cy, r: 15, "data-grip": key });
  }

  // Labels

  label(key, text, style, places) {
    this.labels.push({ key, text, style, places });
  }

  /** Give each label the place where it least meets lines and other labels; the place it has is worth keeping. */
  #placeLabels() {
    const taken = [];
    for (const { key, text, style, places } of this.labels) {
      const half = [measured(text) / 2 + 1, 0.56 * FONT];
      let best = null;
      places.forEach(({ at: [x, y], toward: [ux, uy], gap = 5, cost }, k) => {
        const out = gap + 1 / Math.max(Math.abs(ux) / half[0], Math.abs(uy) / half[1]);
        const centre = [x + out * ux, y + out * uy];
        let total = cost - (this.choices.get(key) === k ? 6 : 0);
        const outside = Math.max(0, half[0] - centre[0], centre[0] + half[0] - this.width) + Math.max(0, half[1] - centre[1], centre[1] + half[1] - this.height);
        if (outside > 0) total += 400 + 20 * outside;
        for (const [other, room] of taken) {
          const [sx, sy] = [half[0] + room[0] - Math.abs(centre[0] - other[0]), half[1] + room[1] - Math.abs(centre[1] - other[1])];
          if (sx > 0 && sy > 0) total += 200 + 4 * sx * sy;
        }
        for (const [start, end] of this.obstacles) total += 2.2 * covered(start, end, centre, half);
        if (!best || total < best.total) best = { total, centre, k };
      });
      this.choices.set(key, best.k);
      taken.push([best.centre, half]);
      const element = this.piece("labels", key, "text", { class: `label ${style}`, x: best.centre[0].toFixed(1), y: (best.centre[1] + 0.33 * FONT).toFixed(1) });
      if (element.text !== text) {
        element.text = text;
        element.replaceChildren(...spans(text));
      }
    }
  }
}

/** The indices of frames, runs of them as "2–4"; what distinguishes conventions follows. */
function indices(arrows) {
  const suffixes = [...new Set(arrows.map(({ suffix = "" }) => suffix))];
  return suffixes.map((suffix) => {
    const numbers = [...new Set(arrows.filter((arrow) => (arrow.suffix ?? "") === suffix).map(({ index }) => Number(index)))].sort((i, j) => i - j);
    const runs = [];
    for (const number of numbers) {
      if (runs.length && runs.at(-1).at(-1) === number - 1) runs.at(-1).push(number);
      else runs.push([number]);
    }
    return runs.map((run) => (run.length > 2 ? `${run[0]}–${run.at(-1)}${suffix}` : run.map((number) => number + suffix).join(","))).join(",");
  }).join(",");
}

/** Places about a tip, best straight ahead, then turning away to either side. */
function around(at, [ux, uy], gap = 4) {
  return [0, 30, -30, 60, -60, 90, -90, 125, -125, 160, -160].map((turned) => {
    const [c, s] = [Math.cos(turned * DEGREE), Math.sin(turned * DEGREE)];
    return { at, toward: [c * ux - s * uy, s * ux + c * uy], gap, cost: Math.abs(turned) / 9 };
  });
}

/** Places on both sides of a line, best near its middle. */
function beside(start, end) {
  const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
  const seen = Math.hypot(dx, dy);
  if (seen < 8) return around(start, [0.7, -0.7], 8);
  return [0.5, 0.35, 0.65, 0.2, 0.8].flatMap((part) =>
    [1, -1].map((side) => ({ at: [start[0] + part * dx, start[1] + part * dy], toward: [(side * dy) / seen, (-side * dx) / seen], gap: 6, cost: 12 * Math.abs(part - 0.5) })));
}

/** How much of a line lies within a box, in pixels (Liang and Barsky, 1984). */
function covered(start, end, centre, half) {
  for (const k of [0, 1]) {
    if (Math.max(start[k], end[k]) < centre[k] - half[k] || Math.min(start[k], end[k]) > centre[k] + half[k]) return 0;
  }
  let [enter, leave] = [0, 1];
  for (const k of [0, 1]) {
    const run = end[k] - start[k];
    const [low, high] = [centre[k] - half[k] - start[k], centre[k] + half[k] - start[k]];
    if (Math.abs(run) < 1e-9) {
      if (low > 0 || high < 0) return 0;
    } else {
      enter = Math.max(enter, Math.min(low / run, high / run));
      leave = Math.min(leave, Math.max(low / run, high / run));
    }
  }
  return leave > enter ? 2 + (leave - enter) * Math.hypot(end[0] - start[0], end[1] - start[1]) : 0;
}

/** The convex hull of points in the plane (Andrew's monotone chain, 1979). */
function hull(points) {
  const sorted = [...points].sort((p, q) => p[0] - q[0] || p[1] - q[1]);
  const half = (listed) => {
    const kept = [];
    for (const p of listed) {
      while (kept.length > 1 && (kept.at(-1)[0] - kept.at(-2)[0]) * (p[1] - kept.at(-2)[1]) <= (kept.at(-1)[1] - kept.at(-2)[1]) * (p[0] - kept.at(-2)[0])) kept.pop();
      kept.push(p);
    }
    return kept.slice(0, -1);
  };
  return [...half(sorted), ...half(sorted.reverse())];
}

/** How wide a label is, about, in pixels. */
function measured(text) {
  if (!widths.has(text)) widths.set(text, pieces(text).reduce((sum, { text: part, index }) => sum + part.length * FONT * (index ? 0.44 : 0.58), 0));
  return widths.get(text);
}
const widths = new Map();

function spans(text) {
  let lowered = false;
  return pieces(text).map(({ text: part, index }) => {
    const span = document.createElementNS(SVG, "tspan");
    span.textContent = part;
    if (index) span.setAttribute("class", "index");
    if (index !== lowered) span.setAttribute("dy", index ? "3.6" : "-3.6");
    lowered = index;
    return span;
  });
}

/**
 * Let a reader take hold of the handles of a stage. `grips` has, for each, how its place follows its value:
 * `along` gives a length's direction, `around` where an angle's handle is at some angle; `value` is what it is now.
 */
export function hold(element, stage, grips) {
  let held = null;
  const place = (event) => {
    const { left, top } = element.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  };
  element.addEventListener("pointerdown", (event) => {
    const key = event.target.dataset.grip;
    if (event.button !== 0 || !key) return;
    const grip = grips(key);
    held = { key, start: place(event), from: grip.value, value: grip.value };
    element.setPointerCapture(event.pointerId);
  });
  element.addEventListener("pointermove", (event) => {
    if (!held) return;
    const grip = grips(held.key);
    const [x, y] = place(event);
    if (grip.along) {
      const [ux, uy] = stage.seeDirection(grip.along);
      const seen = ux * ux + uy * uy;
      if (seen < 16) return;
      held.value = held.from + ((x - held.start[0]) * ux + (y - held.start[1]) * uy) / seen;
    } else {
      const miss = (angle) => {
        const [px, py] = stage.see(grip.around(angle));
        return Math.hypot(px - x, py - y) + 6 * Math.abs(angle - held.value);
      };
      const turns = Array.from({ length: 361 }, (_, k) => (k - 180) * DEGREE);
      held.value = turns.reduce((best, angle) => (miss(angle) < miss(best) ? angle : best));
    }
    grip.changed(held.value, false);
  });
  for (const name of ["pointerup", "pointercancel"]) {
    element.addEventListener(name, () => {
      if (held) grips(held.key).changed(held.value, true);
      held = null;
    });
  }
}

/** Let a reader turn the view of a stage: by pointer, by touch (sideways; up and down scrolls the page), and by keys. */
export function orbit(element, stage) {
  let last = null;
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || event.target.dataset.grip) return;
    last = [event.clientX, event.clientY];
    element.setPointerCapture(event.pointerId);
  });
  element.addEventListener("pointermove", (event) => {
    if (!last) return;
    stage.turn(0.5 * (last[0] - event.clientX), 0.5 * (event.clientY - last[1]));
    last = [event.clientX, event.clientY];
  });
  for (const name of ["pointerup", "pointercancel"]) element.addEventListener(name, () => { last = null; });
  element.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [5, 0], ArrowRight: [-5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5], Home: [] }[event.key];
    if (!turns || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    stage.turn(...turns);
  });
}

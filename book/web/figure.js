// What every live figure shares: its shadow, words for those who listen, motion for those who like it, an address to share.

import sheet from "./figures.css";
import { make } from "./make.js";
import { wake, whenNear } from "./near.js";
import { html, number, spoken } from "./words.js";

const still = matchMedia("(prefers-reduced-motion: reduce)");

export class LiveFigure extends HTMLElement {
  connectedCallback() {
    if (this.shadowRoot) return;
    addEventListener("hashchange", () => this.#readAddress());
    // What the page opens with may be on the screen already, where a picture that becomes a figure would move the text.
    if (this.closest(".bd-article > section > section")) whenNear(this, () => this.#live());
    else this.#live();
    this.#readAddress();
  }

  /** Be alive now, near or not: what asks for the state of a figure cannot wait. */
  wake() {
    wake(this);
  }

  #live() {
    const style = document.createElement("style");
    style.textContent = sheet;
    this.live = make("div", { class: "live" });
    this.status = make("div", { class: "heard", role: "status" });
    // What was put into the page at build, a still picture, is shown in print and where the figure cannot live.
    this.attachShadow({ mode: "open" }).append(style, this.live, this.status, make("slot"));
    this.build();
  }

  /** A sentence of the state, spoken once the reader's hand rests. */
  say(text) {
    clearTimeout(this.pause);
    this.pause = setTimeout(() => { this.status.textContent = text; }, 500);
  }

  /** Draw at the next picture of the screen, however often it is asked for until then. */
  due() {
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      this.draw();
    });
  }

  /** Go from 0 to 1 within some milliseconds; at once where the reader wants no motion. A new motion ends the last. */
  move(milliseconds, show, then = () => {}) {
    cancelAnimationFrame(this.motion);
    if (still.matches) {
      show(1);
      then();
      return;
    }
    const start = performance.now();
    const go = (now) => {
      const part = Math.min(1, (now - start) / milliseconds);
      show(part * part * (3 - 2 * part));
      if (part < 1) this.motion = requestAnimationFrame(go);
      else then();
    };
    this.motion = requestAnimationFrame(go);
  }

  halt() {
    cancelAnimationFrame(this.motion);
    clearTimeout(this.wait);
  }

  get still() {
    return still.matches;
  }

  // The address: #id?name=value&…

  #readAddress() {
    const [id, values] = location.hash.slice(1).split("?");
    if (!this.id || id !== this.id || values === undefined) return;
    this.wake();
    this.read(new URLSearchParams(values));
    this.scrollIntoView({ block: "nearest" });
  }

  async share(values, button) {
    const address = new URL(location.href);
    address.hash = `${this.id}?${new URLSearchParams(values)}`;
    history.replaceState(null, "", address);
    let copied = true;
    await navigator.clipboard?.writeText(address.href).catch(() => { copied = false; });
    const label = button.textContent;
    button.textContent = copied && navigator.clipboard ? "Copied" : "Now in the address bar";
    this.status.textContent = `${button.textContent}: a link to this figure with these values.`;
    setTimeout(() => { button.textContent = label; }, 2000);
  }
}

let count = 0;

/**
 * A number to set by a slider, and beside it by typing. `changed(value, done)` is called at each change;
 * `done` says that the hand has let go.
 */
export class Slider {
  constructor({ symbol, word, style, unit, heard, low, high, step, digits, value, changed }) {
    Object.assign(this, { low, high, step, digits, heard, changed });
    const id = `slider-${(count += 1)}`;
    this.symbol = make("span", { class: "symbol" });
    this.range = make("input", { type: "range", id, min: low, max: high, step, input: () => this.#take(this.range, false), change: () => this.#take(this.range, true) });
    this.field = make("input", { type: "number", min: low, max: high, step, inputmode: "decimal", input: () => this.#take(this.field, false), change: () => this.#take(this.field, true) });
    this.element = make("div", { class: `slider ${style}` },
      make("label", { for: id }, this.symbol, " ", (this.word = make("span", { class: "word" }))),
      this.range, make("span", { class: "field" }, this.field, make("span", { class: "unit", "aria-hidden": "true" }, unit)));
    this.rename(symbol, word);
    this.set(value);
  }

  rename(symbol, word) {
    this.symbol.innerHTML = html(symbol);
    this.word.textContent = word;
    this.field.setAttribute("aria-label", `${spoken(symbol)}, ${word}, ${this.heard}`);
  }

  #take(input, done) {
    const typed = input.valueAsNumber;
    if (!Number.isFinite(typed) && !done) return;
    const value = Number.isFinite(typed) ? Math.max(this.low, Math.min(this.high, typed)) : this.value;
    if (!done && value !== typed) return;
    this.set(value, input === this.field && !done);
    this.changed(value, done);
  }

  /** Move to the nearest value that the slider has, as a hand would. */
  move(value, done) {
    this.set(Math.max(this.low, Math.min(this.high, this.low + this.step * Math.round((value - this.low) / this.step))));
    this.changed(this.value, done);
  }

  set(value, typing = false) {
    this.value = value;
    this.range.value = value;
    if (!typing) this.field.value = Number(value.toFixed(this.digits));
    this.range.setAttribute("aria-valuetext", `${number(value, this.digits)} ${this.heard}`);
    this.range.style.setProperty("--part", (value - this.low) / (this.high - this.low));
  }
}

/** One of several, as radio buttons that look like a switch. */
export function choice({ legend, options, value, changed }) {
  const name = `choice-${(count += 1)}`;
  const radios = options.map(([key, label]) => {
    const radio = make("input", { type: "radio", name, value: key, change: () => changed(key) });
    radio.checked = key === value;
    return [radio, make("label", {}, radio, make("span", {}, label))];
  });
  const element = make("fieldset", { class: "choice" }, make("legend", { class: "heard" }, legend), ...radios.map(([, label]) => label));
  return { element, set: (key) => radios.forEach(([radio]) => { radio.checked = radio.value === key; }) };
}

/** A matrix: its rows and columns named, its entries kept, what changed marked. */
export class Matrix {
  constructor(caption) {
    this.title = make("caption", { html: caption });
    this.cells = [0, 1, 2, 3].map(() => [0, 1, 2, 3].map(() => make("td")));
    const heads = ["n", "o", "a", "p"].map((letter, k) => make("th", { scope: "col", class: "xyz"[k] ?? "" }, letter));
    const sides = ["x", "y", "z", ""].map((letter) => make(letter ? "th" : "td", letter ? { scope: "row" } : { class: "corner" }, letter));
    this.element = make("table", { class: "matrix" }, this.title,
      make("thead", {}, make("tr", {}, make("td", { class: "corner" }), ...heads)),
      make("tbody", {}, ...this.cells.map((row, i) => make("tr", {}, sides[i], ...row))));
  }

  /** Show a matrix; entries that differ from `before` by more than rounding are marked. */
  show(matrix, before, write) {
    matrix.forEach((row, i) => row.forEach((value, k) => {
      const cell = this.cells[i][k];
      const text = write(value, k === 3);
      if (cell.shown !== text) cell.textContent = cell.shown = text;
      const changed = Math.abs(value - before[i][k]) > 1e-9;
      if (cell.marked === changed) return;
      cell.marked = changed;
      cell.classList.toggle("changed", changed);
    }));
  }
}

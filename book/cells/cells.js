// The cells of a page: Run, Edit, Reset, Stop, Run all above.

import { hash, kept } from "./kept.js";
import { make } from "../web/make.js";
import { Outputs } from "./outputs.js";
import { Session, Stopped } from "./session.js";

const script = document.currentScript;
const TALLEST_SCREEN = 480;
const DRAWS = /^\s*(import|from)\s+(matplotlib|dhlib\.plot)\b|^\s*from\s+dhlib\s+import\b.*\bplot\b/m;

/** What the page says of its cells. */
export const page = JSON.parse(document.getElementById("dh-cells").textContent);
export const root = new URL(page.root, location.href).href;
export const session = new Session(root, page.python);

/** The host that has what the book does not serve. */
const elsewhere = new URL(page.python.elsewhere).host;
const fromDisk = location.protocol === "file:";
export const SERVE = "To run code, serve the book: in its folder, python -m http.server, then open http://localhost:8000 here.";
const store = `dh-cells ${page.name}`;

/** The script with the editor, asked for once. */
let loading = null;
const editor = () => (loading ??= new Promise((done, failed) => {
  document.head.append(make("script", { src: script.src.replace(/[^/]+\.js/, "editor.js"), load: () => done(globalThis.DhEditor), error: () => failed(new Error("The editor cannot be loaded.")) }));
}));

/** A cell that nobody sees and others need. */
class Hidden {
  constructor(about) {
    Object.assign(this, { k: about.k, about, text: about.source, ran: null });
  }

  async quietly() {
    return run(this, () => {});
  }
}

/** Send a cell to Python, and remember that it ran, and as what. */
async function run(cell, output) {
  const { text } = cell;
  const generation = session.generation;
  let error = "";
  const heard = (one) => {
    if (one.output_type === "error") error = one.evalue ? `${one.ename}: ${one.evalue}` : one.ename;
    output(one);
  };
  const good = await session.run(text, `cell ${cell.number ?? "of the page"}`, heard, DRAWS.test(text) ? ["matplotlib"] : []);
  cell.error = error;
  if (generation === session.generation) cell.ran = good ? text : null;
  return good;
}

/** A cell of the page. */
export class Cell {
  constructor(bar, number, about) {
    this.bar = bar;
    this.about = about;
    this.k = about.k;
    this.number = number;
    this.ran = null;
    this.element = bar.closest(".cell");
    this.input = bar.closest(".cell_input");
    this.shown = this.input.querySelector("pre");
    this.code = this.shown.closest("[class*=highlight-]");
    this.source = (about.source ?? this.shown.textContent).replace(/\n$/, "");
    this.text = this.source;
    this.key = hash(this.source);
    this.built = this.element.querySelector(".cell_output");
    this.original = this.shown.innerHTML;
    const edited = kept.read(store)?.[this.key];
    if (typeof edited === "string" && edited !== this.source) {
      this.text = edited;
      this.shown.textContent = edited;
    }
    this.build();
    this.refresh();
  }

  button(text, name, act) {
    return make("button", { type: "button", "aria-label": `${text}${name}`, click: act }, text);
  }

  build() {
    const name = ` cell ${this.number}`;
    this.runButton = this.button("Run", name, () => this.start());
    this.editButton = this.button("Edit", name, () => this.edit());
    this.resetButton = this.button("Reset", name, () => this.reset());
    this.stopButton = this.button("Stop", "", () => session.end());
    this.aboveButton = this.button("Run all above", name, () => this.start({ above: true }));
    this.status = make("span", { class: "dh-status", role: "status" });
    this.progress = make("progress", { max: 1, value: 0, "aria-label": "Loading Python", hidden: true });
    const said = this.bar.textContent; // of a cell that cannot run here, the page says so from the start
    this.bar.replaceChildren();
    const above = this.number > 1 ? [this.aboveButton] : [];
    const buttons = this.about.elsewhere ? [] : [this.runButton, this.stopButton];
    this.bar.append(...buttons, this.editButton, this.resetButton, ...(this.about.elsewhere ? [] : above), this.progress, this.status);
    if (this.about.elsewhere) this.say(said);
    if (this.about.mpl) this.say(`This cell draws with matplotlib. Run asks before it is taken from ${elsewhere}.`);
  }

  say(text) {
    if (this.status.textContent !== text) this.status.textContent = text;
  }

  get edited() {
    return this.text !== this.source;
  }

  refresh() {
    this.stopButton.hidden = !this.busy;
    this.runButton.hidden = Boolean(this.busy);
    this.resetButton.hidden = !this.edited && !this.outputs && !this.view;
    this.editButton.hidden = Boolean(this.view);
    this.element.classList.toggle("dh-edited", this.edited);
    this.bar.dataset.state = this.busy ? "busy" : this.state ?? "";
  }

  // Run

  async start({ above = false } = {}) {
    if (this.busy || this.about.elsewhere) return;
    if (fromDisk) {
      this.say(SERVE);
      return;
    }
    this.busy = true;
    this.state = "";
    this.refresh();
    if (document.activeElement === document.body) this.stopButton.focus({ preventScroll: true });
    const listener = (event) => this.#hear(event);
    session.listeners.add(listener);
    try {
      await inTurn(() => this.#run(above));
    } catch (error) {
      this.state = "bad";
      this.say(error instanceof Stopped ? "Stopped. Python has ended and its variables are gone; Run starts it anew." : `This does not work here: ${error.message}`);
    }
    session.listeners.delete(listener);
    const held = document.activeElement === this.stopButton;
    this.busy = false;
    this.progress.hidden = true;
    this.refresh();
    if (held) this.runButton.focus({ preventScroll: true });
  }

  async #run(above) {
    const before = items.filter((item) => item.k < this.k && !item.about?.elsewhere);
    const due = above ? before : before.filter((item) => item.ran === null);
    if (!(await this.#mayFetch(above ? due : [...due, this]))) return;
    const first = session.worker === null;
    if (first) this.say("Starting Python …");
    for (const [k, item] of due.entries()) {
      if (!first || session.times) this.say(`Running what stands above: ${k + 1} of ${due.length} …`);
      const good = above && item instanceof Cell ? await item.run() : await item.quietly();
      if (!good && !page.exercise) {
        this.state = "bad";
        this.say(`Cell ${item.number ?? "above"} fails, so this one was not run. Look there first.`);
        return;
      }
    }
    if (above) {
      this.state = "good";
      this.say(`All ${due.filter((item) => item.number).length} cells above have run.`);
      return;
    }
    this.say("Running …");
    const began = performance.now();
    const good = await this.run();
    this.state = good ? "good" : "bad";
    const seconds = (performance.now() - began) / 1000;
    this.say(good ? `Done${seconds > 1 ? ` in ${seconds.toFixed(1)} s` : ""}.` : "An error: see below.");
  }

  /** Run this cell and show what it gives; the outputs of the build make room. */
  async run() {
    this.place ??= make("div", { class: "cell_output dh-fresh" });
    if (this.built) this.built.hidden = true;
    if (!this.place.isConnected) (this.built ?? this.input).after(this.place);
    this.outputs = new Outputs(this.place, root);
    this.refresh();
    return run(this, (output) => this.outputs.add(output));
  }

  /** Run this cell for what it defines; what it shows stays as it was. */
  async quietly() {
    return run(this, () => {});
  }

  /** Matplotlib alone is not served by the book: ask before the browser takes it from elsewhere. */
  async #mayFetch(due) {
    if (session.fetches || !due.some(({ text }) => DRAWS.test(text))) return true;
    this.say(`matplotlib is not served by this book. Your browser would take it from ${elsewhere}, which then sees your address.`);
    return new Promise((done) => {
      const choose = (yes) => {
        question.remove();
        session.fetches = yes;
        if (!yes) this.say("Not run.");
        done(yes);
      };
      const question = make("span", { class: "dh-ask" },
        make("button", { type: "button", click: () => choose(true) }, `Take it from ${elsewhere}`),
        make("button", { type: "button", click: () => choose(false) }, "Do not run"));
      this.status.after(question);
      question.firstChild.focus();
    });
  }

  #hear(event) {
    if (event.type === "step") this.say(`Starting Python, step ${event.step} of ${event.steps}: ${event.text} …`);
    if (event.type === "loaded") {
      const [loaded, total] = [event.loaded / 1e6, event.total / 1e6];
      this.progress.hidden = false;
      this.progress.value = loaded / total;
      this.progress.title = `${loaded.toFixed(1)} of ${total.toFixed(1)} MB`;
      this.megabytes ??= make("span", { class: "dh-megabytes", "aria-hidden": "true" });
      this.progress.after(this.megabytes);
      this.megabytes.textContent = this.progress.title;
      if (loaded >= total) this.progress.hidden = true;
    }
    if (event.type === "step" && event.step === event.steps) this.megabytes?.remove();
  }

  // Edit

  async edit() {
    if (this.view) {
      this.view.focus();
      return;
    }
    this.say("");
    this.editButton.disabled = true;
    let open;
    try {
      open = await editor();
    } catch (error) {
      this.say(error.message);
      return;
    } finally {
      this.editButton.disabled = false;
    }
    if (this.view) return;
    const details = this.input.closest("details");
    if (details) details.open = true;
    this.code.hidden = true;
    this.view = open({
      parent: this.input.insertBefore(make("div", { class: "dh-editor" }), this.bar),
      text: this.text,
      label: `Code of cell ${this.number}. Shift and Enter runs it, Escape leaves the editor.`,
      changed: (text) => this.take(text),
      run: () => this.start(),
      leave: () => (this.busy ? this.stopButton : this.runButton).focus(),
    });
    this.refresh();
    this.view.focus();
    if (innerHeight > TALLEST_SCREEN) this.say("Shift+Enter runs, Escape leaves the editor.");
  }

  /** Take a text of the reader, and keep it for the next visit. */
  take(text) {
    this.text = text;
    this.ran = null;
    const all = kept.read(store) ?? {};
    if (this.edited) all[this.key] = text;
    else delete all[this.key];
    kept.write(store, Object.keys(all).length ? all : null);
    this.refresh();
    this.changed?.();
  }

  /** Put a text in, as if the reader had typed it. */
  put(text) {
    if (this.view) this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text } });
    else {
      this.shown.textContent = text;
      this.take(text);
    }
  }

  /** Back to what the book has: its code and its output. */
  reset() {
    this.view?.dom.parentElement.remove();
    this.view?.destroy();
    this.view = null;
    this.code.hidden = false;
    this.shown.innerHTML = this.original;
    this.take(this.source);
    this.place?.remove();
    this.outputs = null;
    if (this.built) this.built.hidden = false;
    this.state = "";
    this.say("As the book has it.");
    this.refresh();
    this.editButton.focus({ preventScroll: true });
  }
}

let last = Promise.resolve();

/** Do one thing after the other, in the order in which they were asked for; a Stop ends what waits. */
export function inTurn(work) {
  const { generation } = session;
  const turn = last.then(() => {
    if (generation !== session.generation) throw new Stopped();
    return work();
  });
  last = turn.catch(() => {});
  return turn;
}

const bars = new Map([...document.querySelectorAll(".dh-cell-bar")].map((bar) => [Number(bar.dataset.cell), bar]));
let number = 0;
/** All cells of the page in their order, those that nobody sees included. */
export const items = page.cells.filter(({ role }) => role !== "check").map((about) => (bars.has(about.k) ? new Cell(bars.get(about.k), (number += 1), about) : new Hidden(about)));
export const cells = items.filter((item) => item instanceof Cell);

session.listeners.add((event) => {
  if (event.type === "ended") for (const item of items) item.ran = null;
});
globalThis.DhCells = { cells, items, session };

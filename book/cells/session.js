// The Python of a page: a worker that starts at the first Run, runs one thing after the other, and ends at Stop.

import { figures, take } from "./shared.js";

export class Stopped extends Error {}
export class Broken extends Error {}

export class Session {
  /** `python` says where things are; `told` hears of progress: {text, step, steps} and {loaded, total}. */
  constructor(root, python) {
    Object.assign(this, { root, python, worker: null, asked: new Map(), count: 0, last: Promise.resolve(), listeners: new Set() });
    this.generation = 0;
  }

  tell(event) {
    for (const listener of this.listeners) listener(event);
  }

  get running() {
    return this.asked.size > 0 || this.booting === true;
  }

  /** Start Python if it does not run yet. */
  start() {
    this.ready ??= new Promise((done, failed) => {
      this.booting = true;
      this.began = performance.now();
      this.worker = new Worker(this.root + this.python.worker, { type: "module" });
      this.fail = (error) => { failed(error); for (const { refuse } of this.asked.values()) refuse(error); this.asked.clear(); };
      this.worker.onerror = (event) => this.end(new Broken(event.message || "Python does not start here."));
      this.worker.onmessage = ({ data }) => {
        if (data.type === "ready") {
          this.booting = false;
          this.times = { ...Object.fromEntries(data.times), all: performance.now() - this.began };
          done();
        } else if (data.type === "broken" && data.id === undefined) this.end(new Broken(data.text));
        else if (data.type === "output") this.asked.values().next().value?.output(data.output);
        else if (data.type === "step" || data.type === "loaded") this.tell(data);
        else this.#answer(data);
      };
      this.worker.postMessage({ type: "boot", root: this.root, ...this.python });
    });
    return this.ready;
  }

  #answer({ id, type, good, result, text }) {
    const asked = this.asked.get(id);
    this.asked.delete(id);
    if (type === "broken") asked?.refuse(new Broken(text));
    else asked?.done(type === "ran" ? good : result);
  }

  async #ask(message, output = () => {}) {
    await this.start();
    const id = (this.count += 1);
    return new Promise((done, refuse) => {
      this.asked.set(id, { done, refuse, output });
      this.worker.postMessage({ ...message, id });
    });
  }

  /** Run source; `output` is called with each output as it comes. Says whether it ended well. Packages are fetched first. */
  async run(source, name, output, packages = []) {
    await this.start(); // figures may be moved until then
    return this.#ask({ type: "run", source, name, packages, figures: figures() }, (one) => (one.output_type === "figure" ? take(one) : output(one)));
  }

  /** Call a Python function with plain values. */
  call(module, name, ...values) {
    return this.#ask({ type: "call", module, name, values });
  }

  /** End Python; whatever waits for it is told. */
  end(error = new Stopped()) {
    this.worker?.terminate();
    const fail = this.fail;
    Object.assign(this, { worker: null, ready: undefined, booting: false, fail: undefined });
    this.generation += 1;
    fail?.(error);
    this.tell({ type: "ended", error });
  }
}

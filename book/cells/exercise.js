// An exercise in the page: a Check for each part, points, hints that stay open, and the notebook to hand in.

import { cells, inTurn, items, page, root, session, SERVE } from "./cells.js";
import { kept } from "./kept.js";
import { make } from "../web/make.js";
import { Stopped } from "./session.js";
import { PROGRESS, number, of } from "./points.js";

const { exercise } = page;
const hints = `dh-hints ${exercise.name}`;

/** One question: its answer is a cell above its bar. */
class Part {
  constructor({ k, part }) {
    this.bar = document.querySelector(`.dh-cell-bar[data-cell="${k}"]`);
    this.about = exercise.parts.find(({ id }) => id === part);
    this.k = k;
    this.bar.closest(".cell").classList.add("dh-check");
    this.answer = cells.findLast((cell) => cell.k < k);
    this.button = make("button", { type: "button", "aria-label": `Check ${part}`, click: () => this.check() }, "Check");
    this.points = make("span", { class: "dh-points" });
    this.status = make("span", { class: "dh-status", role: "status" });
    this.bar.append(this.button, this.points, this.status);
    const changed = this.answer.changed;
    this.answer.changed = () => { changed?.(); this.bar.dataset.state = ""; this.status.textContent = ""; };
    this.show();
  }

  get earned() {
    return kept.read(PROGRESS)?.[exercise.name]?.parts?.[this.about.id];
  }

  show() {
    const { earned } = this;
    if (this.about.points === null) return; // graded elsewhere
    this.points.textContent = earned ? of(earned.points, this.about.points) : number(this.about.points);
    this.points.classList.toggle("dh-full", earned?.passed === true);
  }

  async check() {
    if (location.protocol === "file:") {
      this.status.textContent = SERVE;
      return;
    }
    this.button.disabled = true;
    this.bar.dataset.state = "busy";
    const listener = (event) => { if (event.type === "step") this.status.textContent = `Starting Python, step ${event.step} of ${event.steps}: ${event.text} …`; };
    session.listeners.add(listener);
    try {
      await inTurn(async () => {
        this.status.textContent = "Checking …";
        // As the graders do: each cell in its turn; one that fails costs only itself.
        for (const item of items.filter(({ k, ran }) => k < this.k && ran === null)) await (item === this.answer ? item.run() : item.quietly());
        const { passed, says, points } = await session.call("dhlib.grading.page", "check", this.about.id, this.answer.ran === null ? this.answer.error : "");
        this.status.textContent = says;
        this.bar.dataset.state = passed ? "good" : "bad";
        if (points !== null) this.keep({ passed, points });
      });
    } catch (error) {
      this.bar.dataset.state = "bad";
      this.status.textContent = error instanceof Stopped ? "Stopped: not checked." : `This does not work here: ${error.message}`;
    }
    session.listeners.delete(listener);
    this.button.disabled = false;
    this.show();
  }

  /** Keep the points; what was earned once is not lost by trying further. */
  keep(earned) {
    const all = kept.read(PROGRESS) ?? {};
    const mine = (all[exercise.name] ??= { title: exercise.title, out_of: 0, parts: {} });
    const before = mine.parts[this.about.id];
    mine.out_of = exercise.parts.reduce((sum, { points }) => sum + points, 0);
    if (!before || earned.points >= before.points) mine.parts[this.about.id] = earned;
    kept.write(PROGRESS, all);
    total();
    dispatchEvent(new Event("dh-progress"));
  }
}

// All of it

const panel = document.querySelector(".dh-part.dh-all");
const sum = panel.querySelector("[role=status]");

function total() {
  if (exercise.parts.some(({ points }) => points === null)) return;
  const parts = Object.values(kept.read(PROGRESS)?.[exercise.name]?.parts ?? {});
  sum.textContent = `${of(parts.reduce((points, part) => points + part.points, 0), exercise.parts.reduce((points, part) => points + part.points, 0))} here`;
}

/** The exercise with what the reader has written, as `dhlib grade` takes it. */
async function notebook() {
  const pristine = await (await fetch(`${root}exercises/${exercise.name}.ipynb`)).json();
  for (const cell of cells) {
    const { text } = cell;
    if (pristine.cells[cell.k]?.metadata?.dh?.role === "answer") pristine.cells[cell.k].source = text.split(/(?<=\n)/);
  }
  return pristine;
}

async function save(button) {
  if (location.protocol === "file:") {
    sum.textContent = SERVE;
    return;
  }
  const written = new Blob([`${JSON.stringify(await notebook(), null, 1)}\n`], { type: "application/x-ipynb+json" });
  const link = make("a", { href: URL.createObjectURL(written), download: `${exercise.name}.ipynb` });
  button.after(link);
  link.click();
  link.remove();
}

const saving = panel.querySelector("button");
saving.addEventListener("click", () => save(saving));
saving.disabled = false;

export const parts = page.cells.filter(({ role }) => role === "check").map((about) => new Part(about));
total();

// Hints stay as the reader left them.

const folds = [...document.querySelectorAll("main details")].filter((fold) => !fold.closest(".dh-error"));
const open = new Set(kept.read(hints) ?? []);
for (const [k, fold] of folds.entries()) {
  if (open.has(k)) fold.open = true;
  fold.addEventListener("toggle", () => {
    if (fold.open) open.add(k);
    else open.delete(k);
    kept.write(hints, open.size ? [...open] : null);
  });
}

Object.assign(globalThis.DhCells, { parts, notebook });

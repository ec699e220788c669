// The reader's progress: all exercises with their points, to keep as a file and to bring from one.

import { kept } from "./kept.js";
import { make } from "../web/make.js";
import { PROGRESS, of } from "./points.js";

const FORMAT = "dh-book progress 1";
const OURS = /^dh-(progress$|cells exercises\/|hints )/;

const place = document.querySelector(".dh-progress");
const exercises = JSON.parse(document.getElementById("dh-exercises").textContent);
const [saving, forgetting] = place.querySelectorAll("button");
const file = place.querySelector("input");
const said = place.querySelector("[role=status]");

/** Fill the rows, which the build has written with no points. */
function show() {
  const progress = kept.read(PROGRESS) ?? {};
  exercises.forEach(({ name, title, parts }, k) => {
    const earned = progress[name]?.parts ?? {};
    const points = parts.reduce((sum, { id }) => sum + (earned[id]?.points ?? 0), 0);
    const all = parts.reduce((sum, part) => sum + part.points, 0);
    const done = parts.filter(({ id }) => earned[id]?.passed).length;
    const [, count, sum, picture] = place.querySelectorAll("tbody tr")[k].cells;
    count.textContent = `${done} of ${parts.length}`;
    sum.textContent = of(points, all);
    picture.firstChild.value = points;
    picture.firstChild.setAttribute("aria-label", `${title}: ${of(points, all)}`);
  });
}

function written() {
  const entries = Object.keys(localStorage).filter((key) => OURS.test(key)).map((key) => [key, kept.read(key)]);
  return { format: FORMAT, kept: Object.fromEntries(entries) };
}

function save(button) {
  const link = make("a", { href: URL.createObjectURL(new Blob([JSON.stringify(written(), null, 1)], { type: "application/json" })), download: "dh-book-progress.json" });
  button.after(link);
  link.click();
  link.remove();
  said.textContent = "Saved as dh-book-progress.json: your points, what you have written, and which hints are open.";
}

/** Put back what a file keeps; it replaces what is here, exercise by exercise. */
async function load(file) {
  let data;
  try {
    data = JSON.parse(await file.text());
  } catch {
    data = null;
  }
  const entries = data?.format === FORMAT && data.kept && typeof data.kept === "object" ? Object.entries(data.kept).filter(([key]) => OURS.test(key)) : null;
  if (!entries || !entries.every(([, value]) => value && typeof value === "object")) {
    said.textContent = `${file.name} is no progress of this book; it should be a file that this page has saved. Nothing was changed.`;
    return;
  }
  for (const [key, value] of entries) kept.write(key, key === PROGRESS ? { ...kept.read(key), ...value } : value);
  show();
  dispatchEvent(new Event("dh-progress"));
  said.textContent = `Progress of ${entries.length} entries taken from ${file.name}.`;
}

function forget() {
  for (const key of Object.keys(localStorage)) if (OURS.test(key)) kept.write(key, null);
  show();
  for (const badge of document.querySelectorAll(".dh-badge")) badge.remove();
  forgetting.textContent = "Forget all";
  delete forgetting.dataset.sure;
  said.textContent = "Forgotten: points, answers and opened hints.";
}

file.addEventListener("change", () => {
  if (file.files[0]) load(file.files[0]);
  file.value = "";
});
saving.addEventListener("click", () => save(saving));
forgetting.addEventListener("click", () => {
  if (forgetting.dataset.sure) forget();
  else Object.assign(forgetting, { textContent: "Really forget all of it?" }).dataset.sure = "asked";
});
for (const control of [saving, file, forgetting]) control.disabled = false;
show();

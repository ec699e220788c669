// Questions at the end of a chapter: read what was entered, open what was foreseen for it, and say so.

import { NoNumber, read } from "./entries.js";
import { whenNear } from "./near.js";
import { foreseen } from "./sealing.js";

const NOT_YET = "Not yet.";
const PEACE = 5000; // milliseconds

function report(form, state, lead, html = "") {
  const output = form.querySelector("output");
  form.dataset.state = state;
  output.replaceChildren();
  const strong = output.appendChild(document.createElement("strong"));
  strong.textContent = lead;
  if (html) output.insertAdjacentHTML("beforeend", ` <span>${html}</span>`);
}

/** The numbers entered; null where one cannot be read, which is said beside it. */
function entered(form, sealed) {
  if (sealed.kind === "choice") {
    const chosen = [...form.querySelectorAll("input:checked")].map((input) => Number(input.value));
    if (chosen.length === 0) report(form, "unread", "Choose an answer first.");
    return chosen.length ? chosen : null;
  }
  const values = [], faults = [];
  for (const input of form.querySelectorAll("input")) {
    try {
      values.push(read(input.value, input.dataset.unit));
      input.removeAttribute("aria-invalid");
    } catch (fault) {
      if (!(fault instanceof NoNumber)) throw fault;
      input.setAttribute("aria-invalid", "true");
      faults.push({ input, fault });
    }
  }
  if (faults.length === 0) return values;
  const [{ input, fault }] = faults;
  const where = values.length + faults.length > 1 ? `${input.getAttribute("aria-label")}: ` : "";
  report(form, "unread", where + fault.message);
  input.focus();
  return null;
}

async function check(form, sealed) {
  const values = entered(form, sealed);
  if (!values) return;
  report(form, "busy", "Checking …");
  const button = form.querySelector("button");
  button.disabled = true;
  const verdict = await foreseen(sealed, values).finally(() => (button.disabled = false));
  if (form.dataset.state !== "busy") return; // changed meanwhile
  if (verdict?.right) report(form, "right", "Right.", verdict.says);
  else if (verdict?.near) report(form, "wrong", "Close.", "Give all the digits asked for, and round only at the end.");
  else report(form, "wrong", NOT_YET, verdict?.says ?? form.querySelector("template")?.innerHTML ?? "");
}

/** Put the fields of a question into their places. */
function fill(form) {
  for (const place of form.querySelectorAll(".dh-field")) {
    const field = document.createElement("input");
    for (const [name, value] of Object.entries(JSON.parse(place.dataset.field))) field.setAttribute(name, value);
    for (const [name, value] of [["autocapitalize", "off"], ["spellcheck", "false"]]) field.setAttribute(name, value);
    place.replaceWith(field);
  }
}

for (const form of document.querySelectorAll("form.dh-question")) {
  whenNear(form, () => fill(form));
  const sealed = JSON.parse(form.querySelector("script").textContent);
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    check(form, sealed);
  });
  form.addEventListener("input", (event) => {
    event.target.removeAttribute("aria-invalid");
    form.dataset.state = "open";
    form.querySelector("output").replaceChildren();
  });
}

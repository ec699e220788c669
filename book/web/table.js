// A DH table in the page: a row for each joint, the columns in the order of the convention.

import { make } from "./make.js";
import { DEGREE, html, short } from "./words.js";

const COLUMNS = { classic: ["theta", "d", "a", "alpha"], modified: ["alpha", "a", "theta", "d"] };
const LETTER = { theta: "θ", d: "d", a: "a", alpha: "α" };
const ofLink = (name) => name === "a" || name === "alpha";
const isAngle = (name) => name === "theta" || name === "alpha";

export class Table {
  /** `kinds` has R or P for each joint. */
  constructor(convention, kinds) {
    this.convention = convention;
    this.kinds = kinds;
    this.columns = COLUMNS[convention];
    const index = (name) => (convention === "modified" && ofLink(name) ? "i-1" : "i");
    const style = (name) => (ofLink(name) ? "x" : "z");
    this.rows = kinds.map((_, k) => make("tr", {}, make("th", { scope: "row" }, String(k + 1)), ...this.columns.map((name) => make("td", { class: style(name) }))));
    this.element = make("table", { class: "dh" }, make("caption", {}, convention),
      make("thead", {}, make("tr", {}, make("th", { scope: "col", html: "<i>i</i>" }),
        ...this.columns.map((name) => make("th", { scope: "col", class: style(name), html: html(`${LETTER[name]}_{${index(name)}}`) })))),
      make("tbody", {}, ...this.rows));
  }

  /** Show the parameters of each row, a dash where there are none; mark the row that moved, and the entries of a link. */
  show(values, { moved = null, link = null } = {}) {
    this.rows.forEach((row, k) => {
      const itsLink = this.convention === "classic" ? k + 1 : k;
      row.classList.toggle("moved", k === moved);
      this.columns.forEach((name, column) => {
        const cell = row.children[column + 1];
        const value = values[k]?.[name];
        const text = value === undefined ? "–" : isAngle(name) ? `${short(value / DEGREE, 1)}°` : short(value, 4);
        if (cell.textContent !== text) cell.textContent = text;
        cell.classList.toggle("variable", name === (this.kinds[k] === "R" ? "theta" : "d"));
        cell.classList.toggle("marked", link === itsLink && ofLink(name));
      });
    });
  }
}

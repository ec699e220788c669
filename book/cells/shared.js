// What cells and live figures share: the state of each figure goes to Python with a cell, what Python shows comes back.

const all = () => [...document.querySelectorAll("dh-link, dh-robot")].filter((figure) => figure.forCells);
const nameOf = ({ id }) => id.replace(/^live-/, "");

/** The states of the page's figures, by their names. */
export const figures = () => Object.fromEntries(all().map((figure) => [nameOf(figure), figure.forCells]));

/** Let a figure show what a cell has sent. */
export function take({ name, entries }) {
  all().find((figure) => nameOf(figure) === name)?.take(entries);
}

// What cells and live figures share: the state of each figure goes to Python with a cell, what Python shows comes back.

function all() {
  const figures = [...document.querySelectorAll("dh-link, dh-robot")];
  for (const figure of figures) figure.wake?.();
  return figures.filter((figure) => figure.forCells);
}
const nameOf = ({ id }) => id.replace(/^live-/, "");

/** The states of the page's figures, by their names. */
export const figures = () => Object.fromEntries(all().map((figure) => [nameOf(figure), figure.forCells]));

/** Let a figure show what a cell has sent. */
export function take({ name, entries }) {
  all().find((figure) => nameOf(figure) === name)?.take(entries);
}

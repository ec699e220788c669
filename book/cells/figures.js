// What cells and live figures share: a cell shows a chain in a figure of its page, and reads how the reader has moved it.

const figure = (name) => document.getElementById(`live-${name}`);

/** The state of every figure of the page that has one: by name, without its "live-". */
export function states() {
  const found = {};
  for (const element of document.querySelectorAll("dh-robot, dh-link")) {
    if (element.id.startsWith("live-") && element.state) found[element.id.slice(5)] = element.state;
  }
  return found;
}

/** Show what a cell asks for. */
export function show({ name, state }) {
  figure(name)?.show?.(state);
}

// Work that waits for a reader. Of fields and figures that are there from the start the browser asks whether they are
// seen, and so has the whole chapter laid out. So they come when a reader comes near, goes on by Tab or to a place in
// the page, or, one by one, after any other sign of life and when the page was left in peace for a while.

const NEAR = "1000px";
const PEACE = 5000; // milliseconds
const waiting = new Map();
const idle = globalThis.requestIdleCallback ?? setTimeout;

const watch = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) if (isIntersecting) wake(target);
}, { rootMargin: NEAR });

/** Do at once what waits for this element, if anything does. */
export function wake(element) {
  const act = waiting.get(element);
  waiting.delete(element);
  watch.unobserve(element);
  act?.();
}

const wakeAll = () => [...waiting.keys()].forEach(wake);

function wakeOneByOne() {
  const [first] = waiting.keys();
  if (!first) return;
  wake(first);
  idle(wakeOneByOne);
}

const allIsLaidOut = () => document.documentElement.classList.contains("whole");

/** Act once, when a reader comes near an element. */
export function whenNear(element, act) {
  waiting.set(element, act);
  if (allIsLaidOut()) wake(element);
  else watch.observe(element);
}

// All is laid out from when a reader goes on by Tab or to a place in the page (scrolling.js, sections.js).
new MutationObserver(() => { if (allIsLaidOut()) wakeAll(); }).observe(document.documentElement, { attributeFilter: ["class"] });
for (const sign of ["keydown", "pointerdown", "focusin"]) addEventListener(sign, () => idle(wakeOneByOne), { capture: true, once: true });
addEventListener("load", () => setTimeout(() => idle(wakeOneByOne), PEACE));

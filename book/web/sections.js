// Sections far from the screen have no size of their own until they come near (book.css: content-visibility). Whoever
// goes to a place in the page, or comes back to one, needs all sizes: from then on all is laid out.
{
  const layOutAll = () => document.documentElement.classList.add("whole");
  const [{ type } = {}] = performance.getEntriesByType("navigation");
  if (location.hash || (type && type !== "navigate")) layOutAll();
  addEventListener("click", ({ target }) => { if (target.closest?.('a[href*="#"]')) layOutAll(); }, true);
  for (const name of ["hashchange", "popstate"]) addEventListener(name, layOutAll);
}

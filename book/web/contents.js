// Mark in the contents beside the page which section is being read. Bootstrap's own way asks for the place of every
// section at once, and so has the whole chapter laid out before the page answers.
addEventListener("DOMContentLoaded", () => {
  const links = new Map([...document.querySelectorAll(".bd-toc-nav a[href^='#']")].map((link) => [decodeURIComponent(link.hash.slice(1)), link]));
  const seen = new Set();
  let marked = null;
  const watch = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting) seen.add(target.id);
      else seen.delete(target.id);
    }
    const last = [...links].findLast(([id]) => seen.has(id))?.[1];
    if (!last || last === marked) return;
    for (const [link, on] of [[marked, false], [last, true]]) {
      link?.classList.toggle("active", on);
      if (on) link.setAttribute("aria-current", "true");
      else link?.removeAttribute("aria-current");
    }
    marked = last;
  }, { rootMargin: "0px 0px -60%" });
  for (const id of links.keys()) {
    const section = document.getElementById(id);
    if (section) watch.observe(section);
  }
});

// What scrolls by itself can be reached by Tab, so that the arrow keys scroll it; what does not, cannot. Folded parts
// have no size until they are opened, so sizes are watched, and not only the window's.
addEventListener("DOMContentLoaded", () => {
  const regions = document.querySelectorAll("main :is(pre, div.math, table, .cell_output, .output, .pst-scrollable-table-container)");
  const mark = (region) => {
    const scrolls = ["auto", "scroll"].includes(getComputedStyle(region).overflowX) && region.scrollWidth > region.clientWidth;
    if (scrolls) region.tabIndex = 0;
    else region.removeAttribute("tabindex");
  };
  const watch = new ResizeObserver((entries) => { for (const { target } of entries) mark(target); });
  for (const region of regions) watch.observe(region);
  // Sections far from the screen are laid out now, or Tab would pass by what scrolls in them.
  const first = ({ key }) => {
    if (key !== "Tab") return;
    removeEventListener("keydown", first, true);
    document.documentElement.classList.add("whole");
    for (const region of regions) mark(region);
  };
  addEventListener("keydown", first, true);
});

// What scrolls by itself can be reached by Tab, so that the arrow keys scroll it; what does not, cannot. Folded parts
// have no size until they are opened, so sizes are watched, and not only the window's.
addEventListener("DOMContentLoaded", () => {
  const regions = document.querySelectorAll("main :is(pre, div.math, table, .cell_output, .output, .pst-scrollable-table-container)");
  const watch = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      const scrolls = ["auto", "scroll"].includes(getComputedStyle(target).overflowX) && target.scrollWidth > target.clientWidth;
      if (scrolls) target.tabIndex = 0;
      else target.removeAttribute("tabindex");
    }
  });
  for (const region of regions) watch.observe(region);
});

// Points in the sidebar, beside the exercises that were begun.
addEventListener("DOMContentLoaded", () => {
  const show = () => {
    let kept = {};
    try {
      kept = JSON.parse(localStorage.getItem("dh-progress")) ?? {};
    } catch {
      return; // a browser that keeps nothing
    }
    for (const [name, { parts, out_of: all }] of Object.entries(kept)) {
      for (const link of document.querySelectorAll(".bd-sidebar-primary a[href]")) {
        if (!link.pathname.endsWith(`/exercises/${name}.html`)) continue;  // not the solution of the same name
        let badge = link.querySelector(".dh-badge");
        if (!badge) {
          badge = document.createElement("span");
          badge.className = "dh-badge";
          link.append(" ", badge);
        }
        badge.textContent = `${Object.values(parts).reduce((sum, part) => sum + part.points, 0)}/${all}`;
      }
    }
  };
  show();
  addEventListener("dh-progress", show);
});

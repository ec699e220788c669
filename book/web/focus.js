// The theme takes the focus from its buttons when they are pressed, so that no hint stays open under a pointer. Who
// presses them by keys would lose their place: then the focus stays.
addEventListener("click", (event) => {
  const button = event.target.closest?.(".theme-switch-button, .search-button, .primary-toggle, .secondary-toggle");
  if (!button) return;
  if (event.detail === 0) button.blur = () => {};
  else delete button.blur;
}, true);

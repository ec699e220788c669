// Light or dark is settled before anything is drawn. The theme's own script settles it at the end of the page: readers
// of dark pages would see a light one first, and every page would be styled twice.
{
  const { dataset } = document.documentElement;
  if (dataset.mode === "auto") dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

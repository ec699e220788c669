// Keep the book for reading without the network, once the page is there and the reader does not count bytes.
if ("serviceWorker" in navigator && location.protocol.startsWith("http") && !navigator.connection?.saveData) {
  const root = new URL(`${document.documentElement.dataset.content_root ?? "./"}`, location.href);
  addEventListener("load", () => navigator.serviceWorker.register(new URL("sw.js", root)).catch(() => {}));
}

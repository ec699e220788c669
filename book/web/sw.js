// The service worker: after one visit the whole book can be read without the network.
//
// The build puts `SITE` before this: for every file of the site the start of its SHA-256, in two lists. Files `kept` are
// fetched when the worker is installed; files kept `when used` (large ones, downloads) once a page asked for them. The
// cache knows a file by its path and hash, so that another build finds what did not change, and never what did.
//
// With a network the page of the network is shown, and the cache only where the network fails or is silent for long.

const CACHE = "dh-book";
const PATIENCE = 5000;
const AT_ONCE = 6;
const ROOT = self.registration.scope;

const all = { ...SITE.kept, ...SITE.whenUsed };
const key = (path) => `${ROOT}${path}?sha256=${all[path]}`;

/** The file of the site that an address means, or undefined. */
function fileOf(address) {
  const { href } = new URL(address);
  if (!href.startsWith(ROOT)) return undefined;
  const path = decodeURI(href.slice(ROOT.length).replace(/[?#].*/, ""));
  return [path, `${path}index.html`, `${path}.html`].find((name) => Object.hasOwn(all, name));
}

/** Whether a response has the content that this build wrote. */
async function isOfThisBuild(path, response) {
  if (!response.ok) return false;
  const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", await response.clone().arrayBuffer()));
  return [...digest].map((byte) => byte.toString(16).padStart(2, "0")).join("").startsWith(all[path]);
}

async function fetchInto(cache, path) {
  if (await cache.match(key(path))) return;
  const response = await fetch(ROOT + path, { cache: "no-cache" });
  if (!(await isOfThisBuild(path, response))) throw new Error(`${path} is not of this build`);
  await cache.put(key(path), response);
}

async function install() {
  const cache = await caches.open(CACHE);
  const waiting = Object.keys(SITE.kept);
  const fetchNext = async () => {
    for (let path = waiting.pop(); path; path = waiting.pop()) await fetchInto(cache, path);
  };
  await Promise.all(Array.from({ length: AT_ONCE }, fetchNext));
  await self.skipWaiting();
}

/** Forget the files of other builds. */
async function activate() {
  const cache = await caches.open(CACHE);
  const current = new Set(Object.keys(all).map(key));
  for (const request of await cache.keys()) {
    if (!current.has(request.url) && !current.has(decodeURI(request.url))) await cache.delete(request);
  }
  await self.clients.claim();
}

/** The file from the network, or after a while from the cache. */
async function fromNetwork(request, path) {
  const kept = async () => (await caches.open(CACHE)).match(key(path));
  const asked = fetch(request);
  const silent = new Promise((_, fail) => setTimeout(fail, PATIENCE));
  try {
    return await Promise.race([asked, silent]);
  } catch {
    return (await kept()) ?? asked;
  }
}

/** A large file from the cache; else from the network, and then it is kept. */
async function onceUsed(request, path) {
  const cache = await caches.open(CACHE);
  const kept = await cache.match(key(path));
  if (kept) return kept;
  const response = await fetch(request);
  if (await isOfThisBuild(path, response)) await cache.put(key(path), response.clone());
  return response;
}

self.addEventListener("install", (event) => event.waitUntil(install()));
self.addEventListener("activate", (event) => event.waitUntil(activate()));
self.addEventListener("fetch", (event) => {
  const { request } = event;
  const path = request.method === "GET" && !request.headers.has("range") ? fileOf(request.url) : undefined;
  if (path !== undefined) event.respondWith(Object.hasOwn(SITE.whenUsed, path) ? onceUsed(request, path) : fromNetwork(request, path));
});

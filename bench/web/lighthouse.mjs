// Lighthouse over the built book, as a host of static pages serves it: compressed, on a phone, throttling simulated.
// Arguments: the folder of the site, and the Chromium to use. The median of five runs counts: performance wobbles with
// the load of the machine. Ends with an error where a page falls short.
// PAGES (JSON, name to path), FLAGS (for Chromium) and REPORT=json serve bench/book/pages.py.
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { gzipSync } from "node:zlib";
import { launch } from "chrome-launcher";
import lighthouse from "lighthouse";

const [folder, chromePath] = process.argv.slice(2);
const RUNS = Number(process.env.RUNS ?? 5);
const FLAGS = process.env.FLAGS?.split("\n") ?? [];
const AS_JSON = process.env.REPORT === "json";
const PAGES = process.env.PAGES ? JSON.parse(process.env.PAGES) : { landing: "book/index.html", chapter: "book/classic.html", "chapter with an arm": "book/pa10.html", exercise: "exercises/quickshot.html" };
const LEAST = { performance: 95, accessibility: 100, "best-practices": 95, seo: 95 };
const TYPES = { ".html": "text/html", ".css": "text/css", ".js": "text/javascript", ".mjs": "text/javascript", ".svg": "image/svg+xml", ".webmanifest": "application/manifest+json", ".png": "image/png", ".woff2": "font/woff2", ".json": "application/json" };

const server = createServer(async (request, response) => {
  const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname));
  try {
    const content = await readFile(join(folder, path));
    const packed = [".png", ".woff2"].includes(extname(path)) ? content : gzipSync(content);
    const headers = { "Content-Type": TYPES[extname(path)] ?? "application/octet-stream", "Cache-Control": "max-age=600" };
    if (packed !== content) headers["Content-Encoding"] = "gzip";
    response.writeHead(200, headers).end(packed);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((done) => { server.listen(0, "127.0.0.1", done); });
const site = `http://127.0.0.1:${server.address().port}`;

const median = (values) => [...values].sort((one, other) => one - other)[Math.floor(values.length / 2)];
const found = {};
let short = false;
for (const [name, path] of Object.entries(PAGES)) {
  const runs = [];
  for (let k = 0; k < RUNS; k++) {
    const chrome = await launch({ chromePath, chromeFlags: ["--headless=new", "--no-sandbox", "--disable-gpu", ...FLAGS] });
    try {
      runs.push((await lighthouse(`${site}/${path}`, { port: chrome.port, logLevel: "error", onlyCategories: Object.keys(LEAST) })).lhr);
    } finally {
      await chrome.kill();
    }
  }
  const scores = Object.keys(LEAST).map((category) => [category, median(runs.map((run) => Math.round(100 * run.categories[category].score)))]);
  const audit = (id) => median(runs.map((run) => run.audits[id].numericValue));
  const requests = runs.at(-1).audits["network-requests"].details.items;
  found[name] = {
    scores: Object.fromEntries(scores), firstPaint: audit("first-contentful-paint"), largestPaint: audit("largest-contentful-paint"),
    blocked: audit("total-blocking-time"), shift: audit("cumulative-layout-shift"), bytes: audit("total-byte-weight"), requests: requests.length,
    hosts: [...new Set(requests.map(({ url }) => new URL(url)).filter(({ protocol, hostname }) => protocol.startsWith("http") && hostname !== "127.0.0.1").map(({ hostname }) => hostname))].sort(),
    failed: requests.filter(({ statusCode }) => !(statusCode >= 200 && statusCode < 400)).map(({ url }) => url).filter((url) => url.startsWith("http")).sort(),
  };
  if (AS_JSON) continue;
  console.log(`${name.padEnd(20)} ${scores.map(([category, score]) => `${category} ${score}`).join(" · ")}`);
  console.log(`${"".padEnd(20)} first paint ${Math.round(audit("first-contentful-paint"))} ms · largest ${Math.round(audit("largest-contentful-paint"))} ms · blocked ${Math.round(audit("total-blocking-time"))} ms · shift ${audit("cumulative-layout-shift").toFixed(3)} · ${Math.round(audit("total-byte-weight") / 1000)} kB`);
  const [last] = runs;
  for (const { id, title, score, scoreDisplayMode } of Object.values(last.audits)) {
    const counts = Object.values(last.categories).some(({ auditRefs }) => auditRefs.some((ref) => ref.id === id && ref.weight > 0));
    if (counts && scoreDisplayMode !== "notApplicable" && score !== null && score < 0.9) console.log(`${"".padEnd(22)}${id}: ${title} (${score})`);
  }
  short ||= scores.some(([category, score]) => score < LEAST[category]);
}
server.close();
if (AS_JSON) console.log(JSON.stringify(found));
process.exitCode = short ? 1 : 0;

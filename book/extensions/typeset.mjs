// Typeset formulas: a line {tex, display} of JSON in, a line {svg, mathml, glyphs, error} of JSON out.
// Glyph outlines are taken out of the SVG, so that a page holds each of them once. So are the groups that MathJax nests
// to place a glyph, several for each: a page of formulas has thousands, and a browser lays out every one.
import { createInterface } from "node:readline";
import mathjax from "mathjax";

const MathJax = await mathjax.init({
  loader: { load: ["input/tex-full", "output/svg"] },
  tex: { packages: ["base", "ams", "boldsymbol", "cancel", "mathtools", "newcommand"] },
  svg: { fontCache: "local" },
  startup: { typeset: false },
});
const adaptor = MathJax.startup.adaptor;
const NOT_KEPT = /^(data-(?!line|frame)[a-z-]+|xmlns:xlink|xmlns|role|focusable)$/;
const MOVE = /^\s*(?:translate\((-?[\d.]+)[ ,]+(-?[\d.]+)\)|scale\((-?[\d.]+)\))/;
const HERE = { x: 0, y: 0, size: 1 };

// What a chain of moves and scalings comes to, within another; null if there is anything else in it.
function place(transform, { x, y, size }) {
  for (let rest = transform.trim(); rest; ) {
    const move = rest.match(MOVE);
    if (!move) return null;
    if (move[3]) size *= Number(move[3]);
    else [x, y] = [x + size * Number(move[1]), y + size * Number(move[2])];
    rest = rest.slice(move[0].length).trim();
  }
  return { x, y, size };
}

const short = (number) => String(Number(number.toFixed(3)));

function attributesOf(node) {
  const found = {};
  for (const { name, value } of adaptor.allAttributes(node)) if (!NOT_KEPT.test(name)) found[name] = value;
  if (found["xlink:href"]) {
    found.href = found["xlink:href"].replace(/^#MJX-\d+-TEX-/, "#glyph-");
    delete found["xlink:href"];
  }
  return found;
}

// An element as text, put where the groups around it would have put it.
function flat(node, around = HERE) {
  const kind = adaptor.kind(node);
  if (kind === "#text") return adaptor.value(node).replace(/&/g, "&amp;").replace(/</g, "&lt;");
  if (kind === "defs") return "";
  const attributes = attributesOf(node);
  const children = adaptor.childNodes(node);
  if (kind === "g" && Object.keys(attributes).every((name) => name === "transform")) {
    const here = place(attributes.transform ?? "", around);
    if (here) return children.map((child) => flat(child, here)).join("");
  }
  const { x, y, size } = around;
  const moved = [x || y ? `translate(${short(x)},${short(y)})` : "", size === 1 ? "" : `scale(${short(size)})`].join("");
  if (moved && size === 1 && ["use", "rect"].includes(kind) && !attributes.transform) {
    if (x) attributes.x = short(x + Number(attributes.x ?? 0));
    if (y) attributes.y = short(y + Number(attributes.y ?? 0));
  } else if (moved && kind === "svg") {
    return `<g transform="${moved}">${flat(node)}</g>`; // its own transform would be one of CSS
  } else if (moved) attributes.transform = moved + (attributes.transform ?? "");
  const written = Object.entries(attributes).map(([name, value]) => ` ${name}="${value.replace(/"/g, "&quot;")}"`);
  const within = children.map((child) => flat(child)).join("");
  return `<${kind}${written.join("")}${within ? `>${within}</${kind}>` : "/>"}`;
}

// MathML is heard and not seen: without what only spaces it out, and without rows of one.
function spoken(mathml) {
  return mathml
    .replace(/>\s+</g, "><")
    .replace(/ (data-[a-z-]+|columnspacing|rowspacing)="[^"]*"/g, "")
    .replace(/<mrow>(<(mi|mn|mo|mtext)\b[^>]*>[^<]*<\/\2>)<\/mrow>/g, "$1");
}

function typeset({ tex, display }) {
  const container = MathJax.tex2svg(tex, { display });
  const html = adaptor.innerHTML(container);
  const glyphs = {};
  for (const [, id, outline] of html.matchAll(/<path id="MJX-\d+-TEX-([^"]+)" d="([^"]*)"/g)) glyphs[id] = outline;
  const svg = flat(adaptor.firstChild(container)).replace("<svg", '<svg aria-hidden="true"');
  const error = html.match(/data-mjx-error="([^"]*)"/)?.[1] ?? null;
  const mathml = error ? "" : spoken(MathJax.tex2mml(tex, { display }));
  return { svg, mathml, glyphs, error };
}

for await (const line of createInterface({ input: process.stdin })) {
  process.stdout.write(JSON.stringify(typeset(JSON.parse(line))) + "\n");
}

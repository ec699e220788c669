// Typeset formulas: a line {tex, display} of JSON in, a line {svg, mathml, glyphs, error} of JSON out.
// Glyph outlines are taken out of the SVG, so that a page holds each of them once.
import { createInterface } from "node:readline";
import mathjax from "mathjax";

const MathJax = await mathjax.init({
  loader: { load: ["input/tex-full", "output/svg"] },
  tex: { packages: ["base", "ams", "boldsymbol", "cancel", "mathtools", "newcommand"] },
  svg: { fontCache: "local" },
  startup: { typeset: false },
});
const adaptor = MathJax.startup.adaptor;

function typeset({ tex, display }) {
  const container = MathJax.tex2svg(tex, { display });
  const html = adaptor.innerHTML(container);
  const glyphs = {};
  const svg = html
    .replace(/<defs>.*?<\/defs>/s, (defs) => {
      for (const [, id, outline] of defs.matchAll(/<path id="MJX-\d+-TEX-([^"]+)" d="([^"]*)"/g)) glyphs[id] = outline;
      return "";
    })
    .replace(/ xlink:href="#MJX-\d+-TEX-/g, ' href="#glyph-')
    .replace(/ (data-(?!line|frame)[a-z-]+|xmlns:xlink|xmlns|role|focusable)="[^"]*"/g, "")
    .replace("<svg", '<svg aria-hidden="true"');
  const error = html.match(/data-mjx-error="([^"]*)"/)?.[1] ?? null;
  const mathml = error ? "" : MathJax.tex2mml(tex, { display }).replace(/>\s+</g, "><").replace(/ data-[a-z-]+="[^"]*"/g, "");
  return { svg, mathml, glyphs, error };
}

for await (const line of createInterface({ input: process.stdin })) {
  process.stdout.write(JSON.stringify(typeset(JSON.parse(line))) + "\n");
}

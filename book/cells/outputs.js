// Outputs of a cell, as the book shows them.

import { make } from "../web/make.js";

const ORDER = ["text/html", "image/svg+xml", "text/markdown", "text/latex", "text/plain"];
const FORBIDDEN = "script, iframe, object, embed, link, meta, form, base";

/** What shows outputs in a place: `add(output)` one by one, as they come. */
export class Outputs {
  constructor(place, root) {
    Object.assign(this, { place, root, stream: null, list: [] });
    place.replaceChildren();
  }

  add(output) {
    if (output.metadata?.scrapbook) return; // kept for the text of the book, which stands already
    this.list.push(output);
    if (output.output_type === "stream") this.#addStream(output);
    else {
      this.stream = null;
      this.place.append(output.output_type === "error" ? this.#error(output) : this.#data(output.data));
    }
  }

  #addStream({ name, text }) {
    if (this.stream?.name !== name) {
      this.stream = { name, pre: make("pre") };
      this.place.append(make("div", { class: `output stream dh-plain ${name === "stderr" ? "dh-stderr" : ""}` }, this.stream.pre));
    }
    this.stream.pre.append(text);
  }

  #data(data) {
    const mime = ORDER.find((one) => data[one] !== undefined);
    if (mime === "text/html" || mime === "image/svg+xml") return make("div", { class: "output text_html" }, harmless(data[mime]));
    if (mime === "text/latex") return this.#formula(data);
    return make("div", { class: "output dh-plain" }, make("pre", {}, data[mime] ?? ""));
  }

  #formula(data) {
    const place = make("div", { class: "output dh-plain" }, make("pre", {}, data["text/plain"]));
    const [, tex] = data["text/latex"].match(/^\s*\$+(.*?)\$+\s*$/s) ?? [null, data["text/latex"]];
    typesetter(this.root).then((MathJax) => {
      const drawn = MathJax.tex2svg(tex, { display: true }).querySelector("svg");
      drawn.setAttribute("aria-hidden", "true");
      const spoken = make("span", { class: "spoken", html: MathJax.tex2mml(tex, { display: true }) });
      place.className = "output math";
      place.replaceChildren(make("div", { class: "math" }, make("span", { class: "formula" }, drawn, spoken)));
    }).catch(() => {}); // the text stays
    return place;
  }

  /** What was wrong in one line, and where; how Python tells it is folded. */
  #error({ ename, evalue, traceback, line }) {
    const quiet = line === null && traceback.length === 1;
    const said = make("p", { class: "dh-said" }, ...(quiet ? [evalue] : [make("strong", {}, ename), evalue ? `: ${evalue}` : ""]));
    const where = line ? [make("p", { class: "dh-where" }, `In line ${line} of this cell.`)] : [];
    const whole = quiet ? [] : [make("details", {}, make("summary", {}, "Traceback"), make("pre", {}, traceback.join("")))];
    return make("div", { class: "output dh-error" }, said, ...where, ...whole);
  }
}

/** HTML without what could act by itself: a progress file of somebody else may have brought the code. */
function harmless(html) {
  const body = new DOMParser().parseFromString(html, "text/html").body;
  for (const element of body.querySelectorAll(FORBIDDEN)) element.remove();
  for (const element of body.querySelectorAll("*")) {
    for (const { name, value } of [...element.attributes]) {
      if (/^on/i.test(name) || /^\s*javascript:/i.test(value)) element.removeAttribute(name);
    }
  }
  const fragment = document.createDocumentFragment();
  fragment.append(...body.childNodes);
  return fragment;
}

let loading = null;

/** MathJax, which set the formulas of the book too; asked for at the first formula. */
function typesetter(root) {
  return (loading ??= new Promise((done, failed) => {
    globalThis.MathJax = {
      loader: { paths: { mathjax: `${root}mathjax` }, load: ["core", "input/tex-base", "[tex]/ams", "output/svg"] },
      tex: { packages: ["base", "ams"] },
      svg: { fontCache: "local" },
      startup: { typeset: false, ready() { globalThis.MathJax.startup.defaultReady(); globalThis.MathJax.startup.promise.then(() => done(globalThis.MathJax), failed); } },
    };
    document.head.append(make("script", { src: `${root}mathjax/startup.js`, error: failed }));
  }));
}

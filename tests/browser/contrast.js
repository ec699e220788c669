// Contrast of what is drawn: each letter and each line of an SVG figure against what lies behind it.
//
// `contrasts(svg)` returns for each piece its ratio by WCAG 2.2, as rendered: with computed colours, opacity, and the
// surfaces below it in the drawing. Thin lines are no surface: axes that coincide may lie on each other.
(() => {
  const canvas = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  canvas.canvas.width = canvas.canvas.height = 1;
  const read = (colour) => {
    canvas.clearRect(0, 0, 1, 1);
    canvas.fillStyle = colour;
    canvas.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
  };
  const over = ([r, g, b, a], [R, G, B]) => [a * r + (1 - a) * R, a * g + (1 - a) * G, a * b + (1 - a) * B, 1];
  const luminance = (colour) => {
    const [r, g, b] = colour.map((value) => (value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ratio = (one, other) => {
    const [dark, bright] = [luminance(one), luminance(other)].sort((a, b) => a - b);
    return (bright + 0.05) / (dark + 0.05);
  };
  const parent = (element) => element.assignedSlot ?? element.parentElement ?? element.getRootNode().host;
  const opacity = (element) => {
    let all = 1;
    for (let one = element; one; one = parent(one)) all *= Number(getComputedStyle(one).opacity);
    return all;
  };
  const ground = (element) => {
    const layers = [];
    for (let one = element; one; one = parent(one)) layers.push(read(getComputedStyle(one).backgroundColor));
    return layers.reverse().reduce((below, layer) => over(layer, below), [255, 255, 255, 1]);
  };
  const paint = (element, what) => {
    const style = getComputedStyle(element);
    if (style[what] === "none" || (what === "stroke" && parseFloat(style.strokeWidth) === 0)) return null;
    const [r, g, b, a] = read(style[what]);
    const strength = a * Number(style[`${what}Opacity`]) * opacity(element);
    return strength > 0.02 ? [r, g, b, strength] : null;
  };
  const SHAPES = "path, line, polyline, polygon, circle, ellipse, rect";
  const within = (element, svg) => !element.closest("defs, symbol, marker, clipPath") && element.closest("svg") === svg;
  const SURFACE = 4.5;
  /** Drawn wide, and covered but for thin edges. */
  const EDGES = ".le, .br, .rim";
  const isSurface = ({ element, fill, stroke }) => Boolean(fill) || (stroke && parseFloat(getComputedStyle(element).strokeWidth) >= SURFACE);
  const kind = (element) => element.getAttribute("class") ?? "";
  /** The colour behind a point of the screen: the surfaces there that are drawn before a piece; those of its own kind join it. */
  const behind = (pieces, count, point, base) => {
    let colour = base;
    const mine = isSurface(pieces[count]) ? kind(pieces[count].element) : null;
    for (const { element, fill, stroke } of pieces.slice(0, count)) {
      if (!element.isPointInFill || kind(element) === mine || element.matches(EDGES)) continue;
      const at = point.matrixTransform(element.getScreenCTM().inverse());
      if (fill && element.isPointInFill(at)) colour = over(fill, colour);
      if (stroke && parseFloat(getComputedStyle(element).strokeWidth) >= SURFACE && element.isPointInStroke(at)) colour = over(stroke, colour);
    }
    return colour;
  };
  const middle = (element) => {
    if (element.getTotalLength && !(element instanceof SVGRectElement)) {
      const length = element.getTotalLength();
      const at = [1, 2, 3, 4, 5, 6, 7].map((k) => k / 8).map((part) => element.getPointAtLength(part * length).matrixTransform(element.getScreenCTM()));
      return at;
    }
    const { x, y, width, height } = element.getBoundingClientRect();
    return [0.25, 0.5, 0.75].map((part) => new DOMPoint(x + part * width, y + height / 2));
  };

  globalThis.contrasts = (svg) => {
    const base = ground(svg);
    const all = [...svg.querySelectorAll(`${SHAPES}, text`)].filter((element) => within(element, svg) && element.getClientRects().length);
    const pieces = all.map((element) => ({ element, fill: paint(element, "fill"), stroke: paint(element, "stroke") }));
    const found = [];
    for (const [k, { element, fill, stroke }] of pieces.entries()) {
      const letters = element.tagName === "text";
      if (letters && !element.textContent.trim()) continue;
      if (!fill && !stroke) continue;
      const halo = letters && stroke && getComputedStyle(element).paintOrder.startsWith("stroke");
      const worst = middle(element).map((point) => {
        const below = behind(pieces, k, point, base);
        if (letters) return ratio(over(fill, below), halo ? over(stroke, below) : below);
        return Math.max(...[fill, stroke].filter(Boolean).map((colour) => ratio(over(colour, below), below)));
      }).sort((a, b) => a - b);
      // A line may cross another of its own brightness; half of it has to stand out.
      const value = letters ? worst[0] : worst[Math.floor(worst.length / 2)];
      found.push({ letters, value, what: letters ? element.textContent : `${element.tagName}.${element.getAttribute("class") ?? ""}` });
    }
    return found;
  };
})();

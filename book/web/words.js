// Numbers and symbols as a reader sees and hears them.

export const DEGREE = Math.PI / 180;

/** A number with at most `digits` decimals, a real minus, and no "-0". */
export function number(value, digits = 3) {
  const rounded = value.toFixed(digits);
  return (Number(rounded) === 0 ? "0" : rounded).replace("-", "−");
}

/** A number without trailing zeros. */
export const short = (value, digits = 3) => number(Number(value.toFixed(digits)) || 0, digits).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");

/** A matrix entry: whole numbers without decimals, so that what is exactly 0 or 1 can be told from what is nearly so. */
export const entry = (value, digits = 3) => (Math.abs(value - Math.round(value)) < 1e-12 ? short(value, 0) : number(value, digits));

export const degrees = (radians, digits = 1) => `${short(radians / DEGREE, digits)}°`;

export const point = (p, digits = 2) => `(${p.map((value) => short(value, digits)).join(", ")})`;

/** A symbol such as "a_{i-1}" as pieces: letters in italics, what follows "_" as an index. */
export function pieces(symbol) {
  const found = [...symbol.matchAll(/_\{([^}]*)\}|_(.)|([^_]+)/g)];
  return found.map(([, braced, single, plain]) => ({ text: (braced ?? single ?? plain).replace("-", "−"), index: plain === undefined }));
}

/** A symbol as HTML. */
export function html(symbol) {
  const italic = (text) => text.replace(/[A-Za-zα-ω]/g, "<i>$&</i>");
  return pieces(symbol).map(({ text, index }) => (index ? `<sub>${italic(text)}</sub>` : italic(text))).join("");
}

/** A symbol as text, for names that are only heard. */
export const spoken = (symbol) => pieces(symbol).map(({ text }) => text).join(" ");

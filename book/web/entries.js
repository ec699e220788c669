// Numbers as people write them: 0.25, 0,25, −3/4, 2π/3, sqrt(3)/2, 90°, 0.4 m.

const FUNCTIONS = { sqrt: Math.sqrt, "√": Math.sqrt, sin: Math.sin, cos: Math.cos, tan: Math.tan };
const CONSTANTS = { pi: Math.PI, "π": Math.PI };
const TOKEN = /\s*(?:(\d+(?:\.\d*)?(?:e[-+]?\d+)?|\.\d+(?:e[-+]?\d+)?)|(sqrt|sin|cos|tan|pi|[√π])|([-+*/()°])|(\S))/gy;
const UNITS = ["mm", "cm", "m", "rad", "deg", "°", "degrees"];

export class NoNumber extends Error {}

/** The number that a text says, in `unit`; NoNumber says what is wrong with it. */
export function read(text, unit = "") {
  let plain = text.trim().toLowerCase().replace(/[−–]/g, "-").replace(/[·×]/g, "*").replace(/\s*(degrees?|deg)$/, "°");
  if (plain === "") throw new NoNumber("Nothing stands here yet.");
  if (/\d[.,]\d+[.,]\d|,.*,/.test(plain)) throw new NoNumber("Write one number, with one decimal point.");
  plain = plain.replace(",", ".");
  const written = UNITS.find((one) => one !== "°" && plain.endsWith(one) && !plain.endsWith(`a${one}`));
  if (written) {
    if (written !== unit) throw new NoNumber(unit ? `The answer is asked for in ${unit}.` : "The answer has no unit.");
    plain = plain.slice(0, -written.length);
  }
  if (plain.includes("°") && unit !== "°" && unit !== "rad" && !/(sin|cos|tan)/.test(plain)) throw new NoNumber(unit ? `The answer is asked for in ${unit}.` : "The answer is no angle.");
  const value = evaluate(plain, unit);
  if (!Number.isFinite(value)) throw new NoNumber("This is no finite number.");
  return value;
}

function evaluate(text, unit) {
  const tokens = [...text.matchAll(TOKEN)].map(([, number, word, sign, stray]) => ({ number, word, sign, stray }));
  if (tokens.some(({ stray }) => stray) || tokens.length === 0) throw new NoNumber("Write a number, such as 0.25, −3/4 or 2π/3.");
  let at = 0, depth = 0;
  const unfinished = () => new NoNumber("This does not read as a number: a bracket or a factor is missing.");
  const next = (sign) => tokens[at]?.sign === sign && ++at;
  const sum = () => {
    let value = product();
    for (;;) {
      if (next("+")) value += product();
      else if (next("-")) value -= product();
      else return value;
    }
  };
  const product = () => {
    let value = signed();
    for (;;) {
      if (next("*")) value *= signed();
      else if (next("/")) value /= signed();
      else if (tokens[at]?.word || tokens[at]?.sign === "(") value *= factor(); // 2π, 3(1 + 2)
      else return value;
    }
  };
  const signed = () => (next("-") ? -signed() : next("+") ? signed() : factor());
  const factor = () => {
    const token = tokens[at++];
    let value;
    if (token?.number) value = Number(token.number);
    else if (token?.word in CONSTANTS) value = CONSTANTS[token.word];
    else if (token?.word in FUNCTIONS) {
      depth += 1;
      value = FUNCTIONS[token.word](factor());
      depth -= 1;
    } else if (token?.sign === "(") {
      value = sum();
      if (!next(")")) throw unfinished();
    } else throw unfinished();
    // Degrees stand for themselves where degrees are asked for, and are an angle inside sin and cos.
    return next("°") && (depth || unit !== "°") ? (value * Math.PI) / 180 : value;
  };
  const value = sum();
  if (at < tokens.length) throw unfinished();
  return value;
}

// The mathematics of the live figures, and all of it: link matrices, chains, DH1 and DH2, parameters of two frames.
//
// It is dhlib's in the language of the page; tests/web/test_kinematics.py holds each function against dhlib.
// A pose is four rows of four numbers, a vector three numbers; angles are in radians.

const ROUNDING = 1e-15;
const PARALLEL = 1.5e-8;
const QUARTER = Math.PI / 2;

// Vectors

export const add = (u, v) => u.map((value, k) => value + v[k]);
export const subtract = (u, v) => u.map((value, k) => value - v[k]);
export const scale = (factor, v) => v.map((value) => factor * value);
export const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
export const length = (v) => Math.hypot(...v);
export const unit = (v) => scale(1 / length(v), v);
export const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
export const along = (point, distance, direction) => add(point, scale(distance, direction));

// Poses

export const IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
export const column = (pose, k) => [pose[0][k], pose[1][k], pose[2][k]];
export const origin = (pose) => column(pose, 3);

/** Product of poses, from left to right. */
export function multiply(...poses) {
  return poses.reduce((left, right) =>
    left.map((row) => right[0].map((_, k) => row[0] * right[0][k] + row[1] * right[1][k] + row[2] * right[2][k] + row[3] * right[3][k])));
}

/** Inverse of a pose: the transposed rotation, and the origin seen from the other side. */
export function inverse(pose) {
  const p = origin(pose);
  return [0, 1, 2].map((k) => [...column(pose, k), -dot(column(pose, k), p)]).concat([[0, 0, 0, 1]]);
}

/** The pose with this z and this origin whose x is as near as can be to the given one. */
export function frame(z, x, point) {
  const across = unit(along(x, -dot(x, z), z));
  const y = cross(z, across);
  return [0, 1, 2].map((k) => [across[k], y[k], z[k], point[k]]).concat([[0, 0, 0, 1]]);
}

/** Cosine and sine, exactly 0 at quarter turns. */
function cosSin(angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return [Math.abs(c) < ROUNDING ? 0 : c, Math.abs(s) < ROUNDING ? 0 : s];
}

/** T_z(d) R_z(θ): what a joint does. */
export function screwZ(theta, d) {
  const [c, s] = cosSin(theta);
  return [[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]];
}

/** T_x(a) R_x(α): what a link is. */
export function screwX(a, alpha) {
  const [c, s] = cosSin(alpha);
  return [[1, 0, 0, a], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]];
}

// The two conventions

/** R_z(θ) T_z(d) T_x(a) R_x(α). */
export const classic = (theta, d, a, alpha) => multiply(screwZ(theta, d), screwX(a, alpha));

/** R_x(α) T_x(a) R_z(θ) T_z(d). */
export const modified = (alpha, a, theta, d) => multiply(screwX(a, alpha), screwZ(theta, d));

/** The four steps of a link matrix in their order: which parameter, about or along which axis, and its matrix. */
export function steps(convention, { theta, d, a, alpha }) {
  const z = [
    { parameter: "theta", axis: "z", turns: true, matrix: screwZ(theta, 0) },
    { parameter: "d", axis: "z", turns: false, matrix: screwZ(0, d) },
  ];
  const x = [
    { parameter: "a", axis: "x", turns: false, matrix: screwX(a, 0) },
    { parameter: "alpha", axis: "x", turns: true, matrix: screwX(0, alpha) },
  ];
  return convention === "classic" ? [...z, ...x] : [...x.reverse(), ...z];
}

export function linkMatrix(convention, { theta, d, a, alpha }) {
  return convention === "classic" ? classic(theta, d, a, alpha) : modified(alpha, a, theta, d);
}

// Chains, as dhlib/export.py writes them

/** θ and d of a joint at q, with the a and α of its row. */
export function parameters(joint, q) {
  const varied = joint.sign * q + (joint.kind === "R" ? joint.theta : joint.d);
  const { a, alpha } = joint;
  return joint.kind === "R" ? { theta: varied, d: joint.d, a, alpha } : { theta: joint.theta, d: varied, a, alpha };
}

/** Frames 0 to n in the world. */
export function frames(chain, q) {
  const poses = [chain.base];
  chain.joints.forEach((joint, k) => poses.push(multiply(poses[k], linkMatrix(chain.convention, parameters(joint, q[k])))));
  return poses;
}

/** The tool in the world. */
export const forward = (chain, q) => multiply(frames(chain, q).at(-1), chain.tool);

/** The joint axes in the world at q = 0: lines with a point, a direction for growing q, and a kind. */
export function axes(chain) {
  const poses = frames(chain, chain.joints.map(() => 0));
  const onAxis = chain.convention === "classic" ? poses.slice(0, -1) : poses.slice(1);
  return chain.joints.map(({ kind, sign }, k) => ({ point: origin(onAxis[k]), direction: scale(sign, column(onAxis[k], 2)), kind }));
}

/** The rigid motion of all that stands behind an axis when its joint moves by q (Rodrigues' formula). */
export function motion({ point, direction, kind }, q) {
  if (kind === "P") return frame([0, 0, 1], [1, 0, 0], scale(q, direction));
  const [c, s] = [Math.cos(q), Math.sin(q)];
  const turn = (v) => add(add(scale(c, v), scale(s, cross(direction, v))), scale((1 - c) * dot(direction, v), direction));
  const images = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(turn);
  images.push(subtract(point, turn(point)));
  return [0, 1, 2].map((k) => images.map((image) => image[k])).concat([[0, 0, 0, 1]]);
}

/** The pose of the end when every joint moves its part of the arm. */
export const productOfExponentials = (lines, end, q) => multiply(...lines.map((line, k) => motion(line, q[k])), end);

// The elbow circle of an arm with seven joints

/**
 * The circle on which the elbow of an arm with seven joints can go round while the hand rests: its centre, its radius,
 * the axis from shoulder to wrist, and the angle at which the elbow stands on it, 0 where it is nearest to the direction
 * of axis 1. Shoulder, elbow and wrist are where axes 2 and 3, 3 and 4, 5 and 6 meet.
 */
export function elbowCircle(chain, q) {
  const poses = frames(chain, q);
  const onAxis = chain.convention === "classic" ? poses.slice(0, -1) : poses.slice(1);
  const lines = onAxis.map((pose) => ({ point: origin(pose), direction: column(pose, 2) }));
  const meet = (i, j) => commonNormal(lines[i - 1], lines[j - 1]).before;
  const [shoulder, elbow, wrist] = [meet(2, 3), meet(3, 4), meet(5, 6)];
  const axis = unit(subtract(wrist, shoulder));
  const centre = foot({ point: shoulder, direction: axis }, elbow);
  const away = [lines[0].direction, [1, 0, 0]].find((direction) => length(cross(axis, direction)) > 1e-6) ?? [0, 1, 0];
  const start = unit(along(away, -dot(away, axis), axis));
  const radial = subtract(elbow, centre);
  const angle = angleOf(dot(radial, cross(axis, start)), dot(radial, start));
  return { centre, axis, start, elbow, angle, radius: length(radial) };
}

/**
 * Joint values that turn the elbow by an angle round its circle while the hand rests; of the two ways to reach a pose the
 * one nearer to q. Axes 1, 2, 3 meet in the shoulder and 5, 6, 7 in the wrist, each at right angles to the next: then the
 * arm from shoulder to wrist turns as one body, the shoulder's joints take that turn, and the wrist's undo it.
 */
export function turnElbow(chain, q, angle) {
  const directions = axes(chain).map(({ direction }) => direction);
  const turn = (k, value = q[k]) => turnAbout(directions[k], value);
  const [shoulder, elbow, wrist] = [multiply(turn(0), turn(1), turn(2)), turn(3), multiply(turn(4), turn(5), turn(6))];
  const swivel = multiply(turnAbout(elbowCircle(chain, q).axis, angle), shoulder);
  const undone = multiply(inverse(multiply(swivel, elbow)), shoulder, elbow, wrist);
  return [
    ...threeTurns(swivel, directions.slice(0, 3), q.slice(0, 3)),
    q[3],
    ...threeTurns(undone, directions.slice(4), q.slice(4)),
  ];
}

/** Turn the elbow degree by degree until a joint would pass its limit: joint values, how far it got, and that joint, from 0, or null. */
export function moveElbow(chain, q, angle) {
  const count = Math.max(1, Math.ceil((Math.abs(angle) * 180) / Math.PI));
  let now = q;
  for (let k = 0; k < count; k++) {
    const next = turnElbow(chain, now, angle / count);
    const beyond = chain.joints.findIndex(({ limits }, i) => limits && (next[i] < limits[0] - 1e-9 || next[i] > limits[1] + 1e-9));
    if (beyond >= 0) return { q: now, angle: (k * angle) / count, stopped: beyond };
    now = next;
  }
  return { q: now, angle, stopped: null };
}

const turnAbout = (direction, angle) => motion({ point: [0, 0, 0], direction, kind: "R" }, angle);

/** Angles about three directions, each at right angles to the next, whose turns make a rotation; those nearest to given ones. */
function threeTurns(rotation, [first, second, third], near) {
  const across = cross(second, first);
  const image = apply(rotation, third);
  const side = along(image, -dot(image, first), first);
  const rest = Math.atan2(dot(third, across), dot(third, first));
  const solutions = [1, -1].map((sense) => {
    const a = length(side) < 1e-12 ? near[0] : Math.atan2(sense * dot(side, cross(first, across)), sense * dot(side, across));
    const b = Math.atan2(sense * length(side), dot(image, first)) - rest;
    const last = apply(inverse(multiply(turnAbout(first, a), turnAbout(second, b))), apply(rotation, second));
    return [a, b, Math.atan2(dot(last, cross(third, second)), dot(last, second))].map((value, k) => value + 2 * Math.PI * Math.round((near[k] - value) / (2 * Math.PI)));
  });
  const far = (angles) => Math.max(...angles.map((value, k) => Math.abs(value - near[k])));
  return solutions.reduce((one, other) => (far(other) < far(one) ? other : one));
}

/** A direction, turned as a pose turns. */
const apply = (pose, v) => [0, 1, 2].map((i) => dot(pose[i].slice(0, 3), v));

// Lines in space

/** The point of a line that is nearest to a given one. */
export const foot = ({ point, direction }, to) => along(point, dot(subtract(to, point), direction), direction);

/**
 * The common normal of two lines: how they lie, its direction, and its feet on both.
 * Skew and parallel lines: x points from the first to the second. Intersecting lines: first direction × second.
 * Coincident lines have no direction of their own: x is null.
 */
export function commonNormal(first, second) {
  const between = subtract(second.point, first.point);
  const turn = cross(first.direction, second.direction);
  const sine = length(turn);
  const cosine = dot(first.direction, second.direction);
  const size = Math.max(...[...first.point, ...second.point].map(Math.abs));
  const negligible = 1e-13 * size;
  if (Math.atan2(sine, Math.abs(cosine)) < PARALLEL) {
    const before = first.point;
    const after = foot(second, before);
    const gap = length(subtract(after, before));
    if (gap <= negligible) return { kind: "coincident", x: null, before, after: before };
    return { kind: cosine > 0 ? "parallel" : "antiparallel", x: scale(1 / gap, subtract(after, before)), before, after };
  }
  const before = along(first.point, dot(cross(between, second.direction), turn) / sine ** 2, first.direction);
  const after = foot(second, before);
  const x = scale(1 / sine, turn);
  const side = dot(between, turn);
  if (Math.abs(side) <= negligible) return { kind: "intersecting", x, before, after };
  return { kind: "skew", x: scale(Math.sign(side), x), before, after };
}

// DH1 and DH2

/** By how much two frames fail DH1, as an angle, and DH2, as a distance; see dhlib/preconditions.py. */
export function deviation(before, after, convention) {
  const [withX, withZ] = convention === "classic" ? [after, before] : [before, after];
  const [x, z] = [column(withX, 0), column(withZ, 2)];
  const between = subtract(origin(withX), origin(withZ));
  const normal = cross(z, x);
  const sine = length(normal);
  const angle = Math.atan2(Math.abs(dot(x, z)), sine);
  const distance = sine < 1e-9 ? length(cross(z, between)) : Math.abs(dot(between, normal)) / sine;
  return { angle, distance };
}

/** By how much z of a frame misses a joint axis, as an angle and a distance; of a prismatic axis only the angle counts. */
export function deviationFromAxis(pose, line) {
  const z = column(pose, 2);
  const angle = Math.atan2(length(cross(z, line.direction)), Math.abs(dot(z, line.direction)));
  const distance = line.kind === "P" ? 0 : length(subtract(origin(pose), foot(line, origin(pose))));
  return { angle, distance };
}

/** An angle in (-π, π], exactly a quarter turn where it is one but for rounding. */
function angleOf(sine, cosine) {
  const angle = Math.atan2(sine, cosine);
  const quarters = Math.round(angle / QUARTER);
  if (Math.abs(angle - quarters * QUARTER) > 1e-13) return angle;
  return quarters === -2 ? Math.PI : quarters * QUARTER + 0;
}

/** The four parameters that lead from one frame to the next, if DH1 and DH2 hold. */
export function readParameters(before, after, convention) {
  const [[nx, ox, , px], [ny, , ay, py], [, oz, az, pz]] = multiply(inverse(before), after);
  return convention === "classic"
    ? { theta: angleOf(ny, nx), d: pz, a: nx * px + ny * py, alpha: angleOf(oz, az) }
    : { theta: angleOf(-ox, nx), d: ay * py + az * pz, a: px, alpha: angleOf(-ay, az) };
}

/**
 * The table that placed frames spell, as a chain; and by how much it fails to move like the arm.
 * Where z points against its joint's direction, the joint counts the other way, which is as good.
 */
export function chainOfFrames(poses, lines, convention) {
  const onAxis = convention === "classic" ? poses.slice(0, -1) : poses.slice(1);
  const joints = lines.map(({ direction, kind }, k) => ({
    kind,
    ...readParameters(poses[k], poses[k + 1], convention),
    sign: dot(column(onAxis[k], 2), direction) < 0 ? -1 : 1,
    limits: null,
  }));
  return { name: "", unit: "", convention, joints, base: poses[0], tool: IDENTITY };
}

/** The largest difference between where a chain and where the arm itself takes the end, at joint values of all sizes. */
export function disagreement(chain, lines, end) {
  let largest = 0;
  for (let sample = 0; sample < 8; sample++) {
    const q = lines.map((_, k) => 3 * Math.sin(1 + 7.3 * sample + 2.1 * k));
    const [one, other] = [forward(chain, q), productOfExponentials(lines, end, q)];
    one.forEach((row, i) => row.forEach((value, k) => { largest = Math.max(largest, Math.abs(value - other[i][k])); }));
  }
  return largest;
}

// Points, and where they are kept.

export const PROGRESS = "dh-progress";

const plain = new Intl.NumberFormat("en-GB", { maximumFractionDigits: 2 });

/** "1 point", "2.5 points". */
export const number = (points) => `${plain.format(points)} ${points === 1 ? "point" : "points"}`;

/** "1.5 of 3 points". */
export const of = (points, all) => `${plain.format(points)} of ${number(all)}`;

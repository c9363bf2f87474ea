// Days of a living map for tests: a hall whose furniture changes from day to day, as cells, pictures and changes.
// The values of a cell stand in hmi/schema (KeptDays): state * 42 + age in days.
const kAges = 42;
const kStates = { free: 1, moving: 2, semi_static: 3, static: 4, taken_away: 5 };
export const kCell_m = 0.25;

/** The date so many days before today, UTC. */
export const dayBefore = (days) => new Date(Date.now() - days * 86_400_000).toISOString().slice(0, 10);

/** Cells of `extent` (x0, y0, x1, y1, metres), all of them unseen. */
export function cellsOf([x0, y0, x1, y1]) {
  const [width, height] = [Math.round((x1 - x0) / kCell_m), Math.round((y1 - y0) / kCell_m)];
  const cells = new Uint8Array(width * height);
  /** Sets a box (metres) to a state. */
  const fill = ([left, bottom, right, top], state, age_days = 0) => {
    for (let row = Math.round((bottom - y0) / kCell_m); row < Math.round((top - y0) / kCell_m); ++row)
      for (let column = Math.round((left - x0) / kCell_m); column < Math.round((right - x0) / kCell_m); ++column)
        if (row >= 0 && column >= 0 && row < height && column < width) cells[(height - 1 - row) * width + column] = kStates[state] * kAges + age_days;
  };
  /** Sets the cells below a line. */
  const line = ([ax, ay, bx, by], state) => {
    const steps = Math.ceil(Math.hypot(bx - ax, by - ay) / (0.5 * kCell_m));
    for (let i = 0; i <= steps; ++i) {
      const [x, y] = [ax + ((bx - ax) * i) / steps, ay + ((by - ay) * i) / steps];
      fill([Math.floor(x / kCell_m) * kCell_m, Math.floor(y / kCell_m) * kCell_m, (Math.floor(x / kCell_m) + 1) * kCell_m, (Math.floor(y / kCell_m) + 1) * kCell_m], state);
    }
  };
  return { width, height, cells, fill, line };
}

/** A day of the hall of made_up_vehicle.mjs (60 m x 40 m); `thing`: where the things stand that change, as boxes. */
export function hallDay(walls, things, taken = []) {
  const day = cellsOf([0, 0, 60, 40]);
  day.fill([2, 2, 58, 38], "free");
  for (const wall of walls) day.line(wall, "static");
  for (const box of [[6, 32, 14, 34], [44, 33, 52, 35]]) day.fill(box, "static");
  for (const box of things) day.fill(box, "semi_static");
  for (const box of taken) day.fill(box, "taken_away");
  return day;
}

/** Where things stood then, and where they stand now. */
export const then = [[10, 12, 11.25, 13], [34, 30, 36, 31], [24, 8, 25.25, 9]];
export const now = [[34, 30, 36, 31], [26, 8, 27.25, 9], [50, 24, 52.5, 25.25]];

/** What the server says of `then` and `now`. */
export const madeUpChanges = () => [
  { kind: "new", x: 51.25, y: 24.625, width_m: 2.5, height_m: 1.25, cells: 50, from: null, before: dayBefore(3), since: dayBefore(2) },
  { kind: "gone", x: 10.625, y: 12.5, width_m: 1.25, height_m: 1, cells: 20, from: null, before: dayBefore(5), since: dayBefore(3) },
  { kind: "moved", x: 26.625, y: 8.5, width_m: 1.25, height_m: 1, cells: 20, from: [24.625, 8.5], before: dayBefore(1), since: dayBefore(0) },
];

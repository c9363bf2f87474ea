// Days of the living map as a site keeps them: learned/days/DATE.png (mapping/days/day_file.hpp).
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { chunk, png } from "./png.mjs";

const kHead = 33; // signature and IHDR: the place's chunk comes next
const kCell_m = 0.25;
const fileOf = (site, date) => join(site, "learned/days", `${date}.png`);

/** What a kept day says of itself: date, frame and place. */
export function placeOf(site, date) {
  const bytes = readFileSync(fileOf(site, date));
  const [, text] = bytes.subarray(kHead + 8, kHead + 8 + bytes.readUInt32BE(kHead)).toString("latin1").split("\0");
  const [version, day, frame, cell_m, column, row] = text.split(" ");
  return { version, day, frame, cell_m: Number(cell_m), column: Number(column), row: Number(row) };
}

/** Keeps a day of the Map frame `frame` whose lower-left corner is the frame's origin. */
export function keepDay(site, date, frame, { width, height, cells }) {
  const place = chunk("tEXt", Buffer.from(`madori-day\0${1} ${date} ${frame} ${kCell_m} 0 0`, "latin1"));
  const picture = png(width, height, cells);
  mkdirSync(join(site, "learned/days"), { recursive: true });
  writeFileSync(fileOf(site, date), Buffer.concat([picture.subarray(0, kHead), place, picture.subarray(kHead)]));
}

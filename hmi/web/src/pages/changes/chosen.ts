import type { DayChange, DoubtedWall } from "../../api_types";

export type Listed = DayChange | DoubtedWall;

/** By what a row stays the chosen one while its figures change. */
export const keyOf = (one: Listed): string => JSON.stringify("segments" in one ? one.segments : one);

/** The row that was touched; `touched`: how often any was, so that a second touch brings the map there again. */
export interface Chosen {
  key: string;
  touched: number;
}
export const nothingChosen: Chosen = { key: "", touched: 0 };

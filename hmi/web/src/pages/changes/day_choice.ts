import type { KeptDay } from "../../api_types";

const kDay_ms = 86_400_000;
const utc = (date: string): number => Date.parse(`${date}T00:00:00Z`);

/** Civil days (UTC) from a date to another, or to now. */
export function daysSince(date: string, now_ms: number): number {
  return Math.floor(now_ms / kDay_ms) - Math.round(utc(date) / kDay_ms);
}

export const dateText = (date: string, language: string, year = false): string =>
  new Date(utc(date)).toLocaleDateString(language, { day: "numeric", month: "short", timeZone: "UTC", ...(year ? { year: "numeric" } : {}) });

/** With what a day is compared: the kept day before it, the one a week before it, or a day that a person held. */
export type Base = { kind: "before" } | { kind: "week" } | { kind: "held"; date: string };

/** The date of the base; the oldest day where none is a week older; null where there is no other day. */
export function baseDate(days: readonly KeptDay[], shown: string, base: Base): string | null {
  if (base.kind === "held") return base.date !== shown && days.some(({ date }) => date === base.date) ? base.date : null;
  const older = days.filter(({ date }) => date < shown);
  const weekOld = base.kind === "week" ? older.filter(({ date }) => utc(shown) - utc(date) >= 7 * kDay_ms) : older;
  return (weekOld.at(-1) ?? older[0])?.date ?? null;
}

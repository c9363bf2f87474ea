import type { Hypothesis } from "../api_types";

export type Pose = Pick<Hypothesis, "x" | "y" | "yaw">;

/** How far apart two poses are, a metre ahead of the vehicle being turned with it. */
const apart = (a: Pose, b: Pose): number => Math.hypot(a.x - b.x, a.y - b.y, 2 * Math.sin((a.yaw - b.yaw) / 2));

const nearestOf = (places: readonly Pose[], to: Pose): number =>
  places.reduce((best, place, i) => (best < 0 || apart(place, to) < apart(places[best] ?? place, to) ? i : best), -1);

/**
 * Which of the places now ranked is the one that was chosen among those before: the nearest one to it, unless another of those
 * before is nearer to that. -1: it is not among them any more.
 */
export function placeAgain(chosen: Pose, before: readonly Pose[], now: readonly Pose[]): number {
  const found = nearestOf(now, chosen);
  const place = now[found];
  return place && before.every((other) => apart(other, place) >= apart(chosen, place)) ? found : -1;
}

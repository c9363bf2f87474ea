// Pieces of walls, [x1, y1, x2, y2] in metres of the Map frame, laid on one another.
import { readFileSync } from "node:fs";
import { join } from "node:path";

const kNear_m = 0.3;  // of a drawn face: the import's own accuracy, and the thickness of a light wall

export const lengthOf = ([x1, y1, x2, y2]) => Math.hypot(x2 - x1, y2 - y1);

const pointsOf = (piece) => {
  const [x1, y1, x2, y2] = piece;
  const count = Math.ceil(lengthOf(piece) / 0.1);
  return Array.from({ length: count }, (_, i) => [x1 + ((x2 - x1) * (i + 0.5)) / count, y1 + ((y2 - y1) * (i + 0.5)) / count]);
};

/** From a point to a piece, metres. */
export const distance = ([x, y], [x1, y1, x2, y2]) => {
  const [dx, dy] = [x2 - x1, y2 - y1];
  const along = Math.min(1, Math.max(0, ((x - x1) * dx + (y - y1) * dy) / (dx * dx + dy * dy)));
  return Math.hypot(x - x1 - along * dx, y - y1 - along * dy);
};

/** How much of a piece lies on others, 0 to 1. */
export const nearShare = (piece, others) => {
  const points = pointsOf(piece);
  return points.filter((point) => others.some((other) => distance(point, other) < kNear_m)).length / points.length;
};

/** The faces of the sample factory's walls by their numbers, where its imported scan has them. */
export function trueFaces(data) {
  const scan = readFileSync(join(data, "sample_factory/meta.yaml"), "utf8").split("pdf:")[0];
  const [x_m, y_m, yaw_deg] = ["x_m", "y_m", "yaw_deg"].map((name) => Number(scan.match(new RegExp(`${name}: (\\S+)`))[1]));
  const [c, s] = [Math.cos((yaw_deg * Math.PI) / 180), Math.sin((yaw_deg * Math.PI) / 180)];
  const moved = (x, y) => [c * x - s * y + x_m, s * x + c * y + y_m];
  const rows = readFileSync(join(data, "sample_factory/true_walls.csv"), "utf8").trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  return new Map(rows.map(([id, x1, y1, x2, y2]) => [id, [...moved(x1, y1), ...moved(x2, y2)]]));
}

import type { XY } from "./geometry";

/** x' = a x - b y + tx, y' = b x + a y + ty: turning by atan2(b, a), stretching by hypot(a, b), moving by (tx, ty). */
export interface Similarity {
  a: number;
  b: number;
  tx: number;
  ty: number;
}

export const identity: Similarity = { a: 1, b: 0, tx: 0, ty: 0 };

export const apply = ({ a, b, tx, ty }: Similarity, [x, y]: XY): XY => [a * x - b * y + tx, b * x + a * y + ty];
export const scaleOf = ({ a, b }: Similarity): number => Math.hypot(a, b);
export const angleOf = ({ a, b }: Similarity): number => Math.atan2(b, a);

/** First `inner`, then `outer`. */
export function compose(outer: Similarity, inner: Similarity): Similarity {
  const [tx, ty] = apply(outer, [inner.tx, inner.ty]);
  return { a: outer.a * inner.a - outer.b * inner.b, b: outer.b * inner.a + outer.a * inner.b, tx, ty };
}

export function inverse({ a, b, tx, ty }: Similarity): Similarity {
  const n = a * a + b * b;
  const ia = a / n;
  const ib = -b / n;
  return { a: ia, b: ib, tx: -(ia * tx - ib * ty), ty: -(ib * tx + ia * ty) };
}

/** Turns by `angle`, stretches by `scale` and leaves `centre` where it is. */
export function about(centre: XY, angle: number, scale = 1): Similarity {
  const a = scale * Math.cos(angle);
  const b = scale * Math.sin(angle);
  return { a, b, tx: centre[0] - (a * centre[0] - b * centre[1]), ty: centre[1] - (b * centre[0] + a * centre[1]) };
}

/** The motion that brings two fingers from p, q to p2, q2; rigid ones keep the scale and the middle. */
export function fromFingers([p, q]: [XY, XY], [p2, q2]: [XY, XY], rigid: boolean): Similarity {
  const from: XY = [q[0] - p[0], q[1] - p[1]];
  const to: XY = [q2[0] - p2[0], q2[1] - p2[1]];
  const length = Math.hypot(...from);
  if (length === 0) return identity;
  const scale = rigid ? 1 : Math.hypot(...to) / length;
  const angle = Math.atan2(to[1], to[0]) - Math.atan2(from[1], from[0]);
  const middle: XY = [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
  const turned = about(middle, angle, scale);
  return { ...turned, tx: turned.tx + (p2[0] + q2[0]) / 2 - middle[0], ty: turned.ty + (p2[1] + q2[1]) / 2 - middle[1] };
}

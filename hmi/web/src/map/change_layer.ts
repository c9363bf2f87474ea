import Feature from "ol/Feature";
import { LineString, Point, Polygon } from "ol/geom";
import { fromExtent } from "ol/geom/Polygon";
import type VectorSource from "ol/source/Vector";
import { Circle, Fill, RegularShape, Stroke, Style } from "ol/style";
import type { DayChange, DoubtedWall } from "../api_types";
import type { Extent } from "./geometry";
import { palette } from "./theme";

/** The box of what changed, where it is now and where it was. */
export function extentOfChange({ x, y, width_m, height_m, from }: DayChange): Extent {
  const [fx, fy] = from ?? [x, y];
  return [Math.min(x, fx) - width_m / 2, Math.min(y, fy) - height_m / 2, Math.max(x, fx) + width_m / 2, Math.max(y, fy) + height_m / 2];
}

export function extentOfWall({ segments }: DoubtedWall): Extent {
  const xs = segments.flatMap(([x1 = 0, , x2 = 0]) => [x1, x2]);
  const ys = segments.flatMap(([, y1 = 0, , y2 = 0]) => [y1, y2]);
  return [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
}

const halo = (width: number) => new Stroke({ color: palette().paper, width });

/** A disc with a cross for what is gone, a plus for what is new, a point in its direction for what moved: told apart without colour, too. */
function badge(change: DayChange, color: string, large: boolean): Style[] {
  const { kind, x, y, from } = change;
  const radius = large ? 10 : 7;
  const stroke = new Stroke({ color, width: large ? 5 : 3 });
  const sign = from
    ? new RegularShape({ points: 3, radius, rotation: Math.atan2(x - from[0], y - from[1]), fill: new Fill({ color }) })
    : new RegularShape({ points: 4, radius, radius2: 0, angle: kind === "gone" ? Math.PI / 4 : 0, stroke });
  return [new Style({ image: new Circle({ radius: radius + 6, fill: new Fill({ color: palette().paper }), stroke }) }), new Style({ image: sign })];
}

function box(kind: DayChange["kind"], color: string, chosen: boolean): Style[] {
  const lineDash = kind === "gone" ? [8, 7] : undefined;
  const stroke = new Stroke({ color, width: chosen ? 6 : 3, lineDash, lineCap: "butt" });
  return chosen ? [new Style({ stroke: halo(10) }), new Style({ stroke })] : [new Style({ stroke })];
}

const way = (color: string): Style[] => [new Style({ stroke: halo(8) }), new Style({ stroke: new Stroke({ color, width: 4 }) })];

/** Marks what changed, and walls that a person is asked about, on a map; `chosen`: the one that was touched in the list. */
export function showChanges(on: VectorSource, changes: readonly DayChange[], doubts: readonly DoubtedWall[], chosen: DayChange | DoubtedWall | null): void {
  on.clear(true);
  const add = (geometry: Point | LineString | Polygon, style: () => Style[], what: string) => {
    const feature = new Feature(geometry);
    feature.set("mark", what);
    feature.setStyle(style);
    on.addFeature(feature);
  };
  for (const change of changes) {
    const { kind, x, y, width_m, height_m, from } = change;
    const is = change === chosen;
    const colour = () => (kind === "gone" ? palette().red : palette().blue);
    const mark = is ? "chosen" : kind;
    add(fromExtent([x - width_m / 2, y - height_m / 2, x + width_m / 2, y + height_m / 2]), () => box(kind, colour(), is), mark);
    if (from) add(new LineString([[...from], [x, y]]), () => way(colour()), mark);
    add(new Point([x, y]), () => badge(change, colour(), is), mark);
  }
  for (const wall of doubts)
    for (const [x1 = 0, y1 = 0, x2 = 0, y2 = 0] of wall.segments) {
      const stroke = () => new Stroke({ color: palette().amber, width: wall === chosen ? 9 : 5, lineDash: [6, 6], lineCap: "butt" });
      add(new LineString([[x1, y1], [x2, y2]]), () => [new Style({ stroke: halo(wall === chosen ? 15 : 8) }), new Style({ stroke: stroke() })], wall === chosen ? "chosen" : "doubt");
    }
}

import Feature from "ol/Feature";
import { LineString, Point, Polygon } from "ol/geom";
import { fromExtent } from "ol/geom/Polygon";
import type VectorSource from "ol/source/Vector";
import { Fill, RegularShape, Stroke, Style } from "ol/style";
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

/** A cross for what is gone, a plus for what is new or moved: told apart without colour, too. */
function sign(kind: DayChange["kind"], color: string, large: boolean): Style[] {
  const shape = (stroke: Stroke) => new RegularShape({ points: 4, radius: large ? 16 : 10, radius2: 0, angle: kind === "gone" ? Math.PI / 4 : 0, stroke });
  return [new Style({ image: shape(halo(large ? 10 : 7)) }), new Style({ image: shape(new Stroke({ color, width: large ? 6 : 4 })) })];
}

function box(kind: DayChange["kind"], color: string, chosen: boolean): Style[] {
  const lineDash = kind === "gone" ? [8, 7] : undefined;
  const stroke = new Stroke({ color, width: chosen ? 6 : 3, lineDash, lineCap: "butt" });
  return chosen ? [new Style({ stroke: halo(10) }), new Style({ stroke })] : [new Style({ stroke })];
}

/** From where it was to where it is, with a point at that end. */
function way(geometry: LineString, color: string): Style[] {
  const [[ax = 0, ay = 0] = [], [bx = 0, by = 0] = []] = geometry.getCoordinates();
  const head = new RegularShape({ points: 3, radius: 10, rotation: Math.atan2(bx - ax, by - ay), rotateWithView: true, fill: new Fill({ color }) });
  return [new Style({ stroke: halo(8) }), new Style({ stroke: new Stroke({ color, width: 4 }) }), new Style({ geometry: new Point([bx, by]), image: head })];
}

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
    const colour = () => (kind === "gone" ? palette().red : palette().ink);  // blue is what stands
    const mark = change === chosen ? "chosen" : kind;
    add(fromExtent([x - width_m / 2, y - height_m / 2, x + width_m / 2, y + height_m / 2]), () => box(kind, colour(), change === chosen), mark);
    const line = from ? new LineString([[...from], [x, y]]) : null;
    if (line) add(line, () => way(line, colour()), mark);
    else add(new Point([x, y]), () => sign(kind, colour(), change === chosen), mark);
  }
  for (const wall of doubts)
    for (const [x1 = 0, y1 = 0, x2 = 0, y2 = 0] of wall.segments) {
      const stroke = () => new Stroke({ color: palette().amber, width: wall === chosen ? 9 : 5, lineDash: [6, 6], lineCap: "butt" });
      add(new LineString([[x1, y1], [x2, y2]]), () => [new Style({ stroke: halo(wall === chosen ? 15 : 8) }), new Style({ stroke: stroke() })], wall === chosen ? "chosen" : "doubt");
    }
}

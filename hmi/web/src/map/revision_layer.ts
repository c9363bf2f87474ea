import Feature from "ol/Feature";
import { LineString } from "ol/geom";
import type VectorSource from "ol/source/Vector";
import { Stroke, Style } from "ol/style";
import type { RevisionPreview } from "../api_types";
import type { XY } from "./geometry";
import { apply, type Similarity } from "./similarity";
import { palette } from "./theme";

/** Walls of a new drawing on the old one: gone are broken and red, new ones bold and blue; while it is moved, all of it thin. */
function style(kind: "gone" | "added" | "drawn"): Style[] {
  const { red, blue, paper } = palette();
  const under = new Style({ stroke: new Stroke({ color: paper, width: 9 }) });
  if (kind === "drawn") return [new Style({ stroke: new Stroke({ color: blue, width: 2 }) })];
  const stroke = kind === "gone" ? new Stroke({ color: red, width: 5, lineDash: [8, 7], lineCap: "butt" }) : new Stroke({ color: blue, width: 6 });
  return [under, new Style({ stroke })];
}

/** Draws what a revision changes; `by`: how far a finger has moved the new drawing meanwhile, null while nobody moves it. */
export function showRevision(on: VectorSource, preview: RevisionPreview, by: Similarity | null): void {
  on.clear(true);
  const draw = (pieces: RevisionPreview["gone"], kind: "gone" | "added" | "drawn", as = (at: XY): XY => at) =>
    on.addFeatures(pieces.map(([x1, y1, x2, y2]) => {
      const feature = new Feature(new LineString([as([x1, y1]), as([x2, y2])]));
      feature.setStyle(() => style(kind));
      return feature;
    }));
  if (by) return draw(preview.drawn, "drawn", (at) => apply(by, at));
  draw(preview.gone, "gone");
  draw(preview.added, "added");
}

import Feature from "ol/Feature";
import { LineString, Point } from "ol/geom";
import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import { keepDraft, loadDraft } from "../../drafts";
import { useText } from "../../i18n";
import type { FactoryMap } from "../../map/factory_map";
import { toMap, toPixel, type XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { pickOn } from "../../map/pick";
import { corners } from "../../map/snap";
import { AskNumber } from "../../ui/number_pad";
import type { ScaleWay } from "./scale_step";
import { useMeasure } from "./use_measure";
import { Measurements, Verdict } from "./verdict";

type Known = [number, number, number, number, number];

/** Known lengths: tap both ends, give the metres; each with its residual, and a verdict before anything is applied. */
export function KnownScale({ site, walls, ways, finish }: ScaleWay) {
  const t = useText();
  const height = site.drawing?.height_px ?? 1;
  const unit = site.scale?.m_per_px ?? 1;
  const [known, setKnown] = useState<Known[]>(loadDraft<Known[]>(site.name, "scale")?.value ?? []);
  const [ends, setEnds] = useState<XY[]>([]);
  const map = useRef<FactoryMap | null>(null);
  const { result, apply } = useMeasure(known.length > 0 ? { known } : null);

  const keep = (next: Known[]) => {
    keepDraft(site.name, "scale", { revision: "", value: next });
    setKnown(next);
  };
  useEffect(() => {
    const sketch = map.current?.sketch;
    if (!sketch) return;
    sketch.clear();
    const line = (a: XY, b: XY, label: string, outlier: boolean) => {
      const feature = new Feature(new LineString([toMap(a, height, unit), toMap(b, height, unit)]));
      feature.setProperties({ label, outlier });
      sketch.addFeature(feature);
    };
    known.forEach(([u1, v1, u2, v2, m], i) => line([u1, v1], [u2, v2], t("unit.m", { value: m }), result?.residuals[i]?.outlier ?? false));
    if (ends[0] && ends[1]) line(ends[0], ends[1], "?", false);
    else if (ends[0]) sketch.addFeature(new Feature(new Point(toMap(ends[0], height, unit))));
  }, [known, ends, result]);

  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    const snaps = corners(walls.walls, 8 * unit);
    return pickOn(made.map, {
      picked: (at) => setEnds((old) => (old.length === 1 ? [...old, toPixel(at, height, unit)] : [toPixel(at, height, unit)])),
      corners: () => snaps,
      active: () => true,
    });
  };
  const take = (metres: number | null) => {
    const [a, b] = ends;
    if (a && b && metres !== null) keep([...known, [...a, ...b, metres]]);
    setEnds([]);
  };
  return (
    <>
      <MapView ready={ready} />
      <aside>
        {ways}
        {result && <Verdict site={site} result={result} />}
        {(ends.length === 1 || !result) && <p class="quiet">{ends.length === 1 ? t("scale.length.second") : t("scale.length.hint")}</p>}
        <Measurements labels={known.map((row) => t("unit.m", { value: row[4] }))} result={result} remove={(i) => keep(known.filter((_, j) => j !== i))} />
        <span class="spring" />
        {finish(result, apply)}
      </aside>
      {ends.length === 2 && <AskNumber label={t("scale.metres")} unit="m" value={null} least={0.1} most={10000} done={take} cancel={() => setEnds([])} />}
    </>
  );
}

import Feature from "ol/Feature";
import { Point } from "ol/geom";
import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import { keepDraft, loadDraft } from "../../drafts";
import { useText } from "../../i18n";
import type { FactoryMap } from "../../map/factory_map";
import { toMap, toPixel, type XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { toLatLon } from "../../map/mercator";
import type { PhotoMap } from "../../map/photo_map";
import { PhotoView } from "../../map/photo_view";
import { pickOn } from "../../map/pick";
import { corners, withMiddles } from "../../map/snap";
import { FetchTiles } from "./fetch_tiles";
import type { ScaleWay } from "./scale_step";
import { useMeasure } from "./use_measure";
import { useTiles } from "./use_tiles";
import { Measurements, Verdict } from "./verdict";

type Pair = [number, number, number, number];  // u, v, latitude, longitude

/** Pairs of points: a tap on the drawing, then the same point on the photograph. */
export function PairScale({ site, walls, ways, finish }: ScaleWay) {
  const t = useText();
  const height = site.drawing?.height_px ?? 1;
  const unit = site.scale?.m_per_px ?? 1;
  const { info, key, load } = useTiles();
  const [pairs, setPairs] = useState<Pair[]>(loadDraft<Pair[]>(site.name, "pairs")?.value ?? []);
  const [begun, setBegun] = useState<XY | null>(null);
  const map = useRef<FactoryMap | null>(null);
  const photo = useRef<PhotoMap | null>(null);
  const now = useRef({ begun, pairs });
  now.current = { begun, pairs };
  const { result, apply } = useMeasure(pairs.length >= 2 ? { control: pairs } : null);

  // `now` at once: two quick touches may come before the page is drawn again
  const begin = (at: XY | null) => {
    now.current.begun = at;
    setBegun(at);
  };
  const keep = (next: Pair[]) => {
    now.current.pairs = next;
    keepDraft(site.name, "pairs", { revision: "", value: next });
    setPairs(next);
  };
  useEffect(() => {
    const outlier = (i: number) => result?.residuals[i]?.outlier ?? false;
    const sketch = map.current?.sketch;
    sketch?.clear();
    const mark = (at: XY, label: string, bad: boolean) => {
      const feature = new Feature(new Point(toMap(at, height, unit)));
      feature.setProperties({ label, outlier: bad });
      sketch?.addFeature(feature);
    };
    pairs.forEach(([u, v], i) => mark([u, v], String(i + 1), outlier(i)));
    if (begun) mark(begun, String(pairs.length + 1), false);
    photo.current?.show(pairs.map(([, , latitude, longitude], i) => ({ latitude, longitude, label: String(i + 1), outlier: outlier(i) })));
  }, [pairs, begun, result, info]);

  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.fitWalls();
    const snaps = withMiddles(corners(walls.walls, 8 * unit), 24 * unit);
    return pickOn(made.map, { picked: (at) => begin(toPixel(at, height, unit)), corners: () => snaps, active: () => true });
  };
  const photoReady = (made: PhotoMap) => {
    photo.current = made;
    const picked = (at: XY) => {
      const { begun: from, pairs: old } = now.current;
      if (!from) return;
      const { latitude, longitude } = toLatLon(at);
      keep([...old, [from[0], from[1], latitude, longitude]]);
      begin(null);
    };
    const end = pickOn(made.map, { picked, corners: () => [], active: () => now.current.begun !== null });
    return () => {
      end();
      photo.current = null;
    };
  };
  return (
    <>
      <div class="split">
        <MapView ready={ready} />
        {info && <PhotoView key={key} site={site.name} info={info} ready={photoReady} />}
      </div>
      <aside>
        {ways}
        {info && <p class="quiet" role="status">{begun ? t("scale.pairs.photo", { number: pairs.length + 1 }) : t("scale.pairs.drawing", { number: pairs.length + 1 })}</p>}
        {result && <Verdict site={site} result={result} />}
        <Measurements labels={pairs.map(([, , lat, lon]) => `${lat.toFixed(6)}, ${lon.toFixed(6)}`)} result={result} remove={(i) => keep(pairs.filter((_, j) => j !== i))} />
        {pairs.length === 0 && <FetchTiles site={site} done={load} />}
        <span class="spring" />
        {finish(result, apply)}
      </aside>
    </>
  );
}

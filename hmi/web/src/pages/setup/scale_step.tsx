import Feature from "ol/Feature";
import { LineString, Point } from "ol/geom";
import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { ScaleRequest, ScaleResult, Site, Walls } from "../../api_types";
import { keepDraft, loadDraft } from "../../drafts";
import { useText } from "../../i18n";
import type { FactoryMap } from "../../map/factory_map";
import { toMap, toPixel, type XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { Icon } from "../../ui/icon";
import { attempt } from "../../ui/toast";
import { PhotoScale } from "./photo_scale";
import { Measurements, Verdict } from "./verdict";

type Known = [number, number, number, number, number];

/** Known lengths, each with its residual, and a verdict before anything is applied. */
function KnownScale({ site, walls, changed }: { site: Site; walls: Walls; changed: () => void }) {
  const t = useText();
  const height = site.drawing?.height_px ?? 1;
  const unit = site.scale?.m_per_px ?? 1;
  const [known, setKnown] = useState<Known[]>(loadDraft<Known[]>(site.name, "scale")?.value ?? []);
  const [first, setFirst] = useState<XY | null>(null);
  const [pair, setPair] = useState<[XY, XY] | null>(null);
  const [metres, setMetres] = useState("");
  const [result, setResult] = useState<ScaleResult | null>(null);
  const map = useRef<FactoryMap | null>(null);
  const state = useRef({ first, pair });
  state.current = { first, pair };

  const keep = (next: Known[]) => {
    keepDraft(site.name, "scale", { revision: "", value: next });
    setResult(null);
    setKnown(next);
  };
  useEffect(() => {
    const sketch = map.current?.sketch;
    if (!sketch) return;
    sketch.clear();
    const add = (a: XY, b: XY, label: string, outlier: boolean) => {
      const line = new Feature(new LineString([toMap(a, height, unit), toMap(b, height, unit)]));
      line.setProperties({ label, outlier });
      sketch.addFeature(line);
    };
    known.forEach(([u1, v1, u2, v2, m], i) => add([u1, v1], [u2, v2], `${m} m`, result?.residuals[i]?.outlier ?? false));
    if (pair) add(pair[0], pair[1], "?", false);
    else if (first) sketch.addFeature(new Feature(new Point(toMap(first, height, unit))));
  }, [known, first, pair, result]);

  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.map.on("click", (event) => {
      const at = toPixel(event.coordinate as XY, height, unit);
      const { first: begun, pair: done } = state.current;
      if (begun && !done) setPair([begun, at]);
      else {
        setPair(null);
        setFirst(at);
      }
    });
  };
  const addLength = () => {
    const length = Number(metres.replace(",", "."));
    if (!pair || !(length > 0)) return;
    keep([...known, [...pair[0], ...pair[1], length]]);
    setFirst(null);
    setPair(null);
    setMetres("");
  };
  const ask = (apply: boolean) => {
    const request: ScaleRequest = { known, apply };
    void attempt(async () => setResult(await api.scale(request))).then((good) => good && apply && changed());
  };
  return (
    <>
      <MapView ready={ready} />
      <aside>
        <section class="card">
          <p>
            {site.scale
              ? t("scale.now", { scale: (1000 * site.scale.m_per_px).toFixed(3), method: site.scale.method })
              : t("scale.none")}
          </p>
          <p class="quiet">{t("scale.length.hint")}</p>
          <form onSubmit={(event) => { event.preventDefault(); addLength(); }}>
            <label>
              {t("scale.metres")}
              <input class="target wide" type="text" inputMode="decimal" disabled={!pair} value={metres}
                onInput={(event) => setMetres(event.currentTarget.value)} />
            </label>
            <button class="target wide" type="submit" disabled={!pair || !(Number(metres.replace(",", ".")) > 0)}>
              <Icon name="plus" /> {t("scale.length")}
            </button>
          </form>
        </section>
        <section class="card">
          <Measurements labels={known.map((row) => `${row[4]} m`)} result={result} remove={(i) => keep(known.filter((_, j) => j !== i))} />
          {result && <Verdict result={result} />}
          <div class="buttons">
            <button class="target" disabled={known.length === 0} onClick={() => ask(false)}>{t("scale.measure")}</button>
            <button class="target primary" disabled={known.length === 0 || result?.verdict === "refused"} onClick={() => ask(true)}>
              {t("scale.apply")}
            </button>
          </div>
        </section>
      </aside>
    </>
  );
}

/** Step 2: the drawing gets its true scale, by known lengths or by points on an aerial photograph. */
export function ScaleStep(props: { site: Site; walls: Walls; changed: () => void }) {
  const t = useText();
  const [byPhoto, setByPhoto] = useState(false);
  return (
    <div class="rows">
      <div class="with-map">{byPhoto ? <PhotoScale {...props} /> : <KnownScale {...props} />}</div>
      <div class="switch">
        <button class="target" aria-pressed={!byPhoto} onClick={() => setByPhoto(false)}>{t("scale.length")}</button>
        <button class="target" aria-pressed={byPhoto} onClick={() => setByPhoto(true)}>{t("scale.photo")}</button>
      </div>
    </div>
  );
}

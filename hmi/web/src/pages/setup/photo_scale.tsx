import Feature from "ol/Feature";
import { Point } from "ol/geom";
import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { ScaleResult, Site, TileInfo, Walls } from "../../api_types";
import { keepDraft, loadDraft } from "../../drafts";
import { useText } from "../../i18n";
import type { FactoryMap } from "../../map/factory_map";
import { toMap, toPixel, type XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { PhotoMap } from "../../map/photo_map";
import { attempt, tell } from "../../ui/toast";
import { Measurements, Verdict } from "./verdict";

type Pair = [number, number, number, number];  // u, v, latitude, longitude

const decimal = (text: string) => Number(text.replace(",", "."));

function FetchTiles({ done }: { done: () => void }) {
  const t = useText();
  const [wanted, setWanted] = useState({ latitude: "", longitude: "", zoom: "18", source: "seamlessphoto" });
  const [busy, setBusy] = useState("");
  const fetchAll = async () => {
    const request = { latitude_deg: decimal(wanted.latitude), longitude_deg: decimal(wanted.longitude), zoom: Number(wanted.zoom), radius_m: 150, source: wanted.source };
    if (!(await attempt(() => api.fetchTiles(request)))) return;
    for (;;) {
      const job = await api.job();
      setBusy(`${job.stage} ${(100 * job.share).toFixed(0)} %`);
      if (job.running) await new Promise((resolve) => setTimeout(resolve, 300));
      else {
        setBusy("");
        if (job.error !== "") tell("tiles", job.error);
        done();
        return;
      }
    }
  };
  const field = (name: keyof typeof wanted, label: string) => (
    <label>
      {label}
      <input class="target wide" value={wanted[name]} onInput={(event) => setWanted({ ...wanted, [name]: event.currentTarget.value })} />
    </label>
  );
  return (
    <section class="card">
      {field("latitude", t("scale.latitude"))}
      {field("longitude", t("scale.longitude"))}
      {field("zoom", t("scale.zoom"))}
      {field("source", t("scale.source"))}
      <button class="target wide" disabled={busy !== "" || !Number.isFinite(decimal(wanted.latitude)) || wanted.latitude === ""} onClick={() => void fetchAll()}>
        {busy === "" ? t("scale.photo.fetch") : busy}
      </button>
    </section>
  );
}

/** Pairs of points: a tap on the drawing, then the same point on the photograph. */
export function PhotoScale({ site, walls, changed }: { site: Site; walls: Walls; changed: () => void }) {
  const t = useText();
  const height = site.drawing?.height_px ?? 1;
  const unit = site.scale?.m_per_px ?? 1;
  const [info, setInfo] = useState<TileInfo | null>(null);
  const [pairs, setPairs] = useState<Pair[]>(loadDraft<Pair[]>(site.name, "pairs")?.value ?? []);
  const [begun, setBegun] = useState<XY | null>(null);
  const [result, setResult] = useState<ScaleResult | null>(null);
  const map = useRef<FactoryMap | null>(null);
  const photo = useRef<PhotoMap | null>(null);
  const target = useRef<HTMLDivElement>(null);
  const state = useRef({ begun, pairs });
  state.current = { begun, pairs };

  const load = () => void api.tiles().then(setInfo, () => undefined);
  useEffect(load, []);
  const keep = (next: Pair[]) => {
    keepDraft(site.name, "pairs", { revision: "", value: next });
    setResult(null);
    setPairs(next);
  };
  useEffect(() => {
    if (!target.current || !info || info.tiles.length === 0) return undefined;
    const made = new PhotoMap(target.current, info, (latitude, longitude) => {
      const { begun: from, pairs: old } = state.current;
      if (!from) return;
      keep([...old, [from[0], from[1], latitude, longitude]]);
      setBegun(null);
    });
    photo.current = made;
    return () => made.dispose();
  }, [info]);
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
    if (begun) mark(begun, "?", false);
    photo.current?.show(pairs.map(([, , latitude, longitude], i) => ({ latitude, longitude, label: String(i + 1), outlier: outlier(i) })));
  }, [pairs, begun, result, info]);

  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.map.on("click", (event) => setBegun(toPixel(event.coordinate as XY, height, unit)));
  };
  const ask = (apply: boolean) =>
    void attempt(async () => setResult(await api.scale({ control: pairs, apply }))).then((good) => good && apply && changed());
  return (
    <>
      <div class="split">
        <MapView ready={ready} />
        {info && info.tiles.length > 0 && (
          <div class="map">
            <div ref={target} class="map-canvas" role="application" aria-label={t("scale.photo")} tabIndex={0} />
            <p class="attribution">{info.attribution}</p>
          </div>
        )}
      </div>
      <aside>
        <section class="card"><p class="quiet">{t("scale.photo.hint")}</p></section>
        {pairs.length > 0 && (
          <section class="card">
            <Measurements labels={pairs.map(([, , lat, lon]) => `${lat.toFixed(6)}, ${lon.toFixed(6)}`)} result={result} remove={(i) => keep(pairs.filter((_, j) => j !== i))} />
            {result && <Verdict result={result} />}
            <div class="buttons">
              <button class="target" disabled={pairs.length < 2} onClick={() => ask(false)}>{t("scale.measure")}</button>
              <button class="target primary" disabled={pairs.length < 2 || result?.verdict === "refused"} onClick={() => ask(true)}>{t("scale.apply")}</button>
            </div>
          </section>
        )}
        <FetchTiles done={load} />
      </aside>
    </>
  );
}

import { useEffect, useState } from "preact/hooks";
import { api } from "../../api";
import type { Site, TileSourceInfo } from "../../api_types";
import { keepDraft } from "../../drafts";
import { useText } from "../../i18n";
import type { PhotoPlace } from "../../map/photo_map";
import { NumberField } from "../../ui/number_pad";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";
import { JobCard } from "./job_card";

/** Fetches aerial photographs of a place: from a source that is known by name, or from any server by its address. */
export function FetchTiles({ site, done }: { site: Site; done: () => void }) {
  const t = useText();
  const [latitude, setLatitude] = useState<number | null>(site.georeference?.latitude_deg ?? null);
  const [longitude, setLongitude] = useState<number | null>(site.georeference?.longitude_deg ?? null);
  const [zoom, setZoom] = useState(18);
  const [radius, setRadius] = useState(100);
  const [source, setSource] = useState("");
  const [sources, setSources] = useState<readonly TileSourceInfo[]>([]);
  const [attribution, setAttribution] = useState("");
  const [working, setWorking] = useState(false);
  const template = source.includes("{z}");
  useEffect(() => void api.tileSources().then((list) => {
    setSources(list);
    setSource((old) => (old === "" ? (list[0]?.name ?? "") : old));
  }, () => undefined), []);
  const fetchAll = () => {
    if (latitude === null || longitude === null) return;
    keepDraft(site.name, "photographs", { revision: "", value: { latitude, longitude, radius_m: radius } satisfies PhotoPlace });
    void attempt(() => api.fetchTiles({ latitude_deg: latitude, longitude_deg: longitude, zoom, radius_m: radius, source, ...(template ? { attribution } : {}) })).then(setWorking);
  };
  if (working) return <JobCard kind="tiles" done={done} ended={() => setWorking(false)} />;
  return (
    <section class="fetch-tiles">
      <h3>{t("scale.photo.fetch")}</h3>
      <div class="buttons">
        <NumberField label={t("scale.latitude")} value={latitude} unit="°" least={-85} most={85} change={setLatitude} />
        <NumberField label={t("scale.longitude")} value={longitude} unit="°" least={-180} most={180} change={setLongitude} />
        <NumberField label={t("scale.zoom")} value={zoom} least={10} most={22} change={(value) => setZoom(Math.round(value ?? zoom))} />
        <NumberField label={t("scale.radius")} value={radius} unit="m" least={20} most={2000} change={(value) => setRadius(value ?? radius)} />
      </div>
      <label class="text-field">
        {t("scale.source")}
        <input class="target wide" list="tile-sources" value={source} onInput={(event) => setSource(event.currentTarget.value)} />
        <datalist id="tile-sources">{sources.map((each) => <option key={each.name} value={each.name} />)}</datalist>
      </label>
      {template && <label class="text-field">{t("scale.attribution")}<input class="target wide" value={attribution} onInput={(event) => setAttribution(event.currentTarget.value)} /></label>}
      <div class="buttons">
        <Tool icon="download" label={t("scale.photo.fetch")} primary disabled={latitude === null || longitude === null || source === ""} onClick={fetchAll} />
      </div>
    </section>
  );
}

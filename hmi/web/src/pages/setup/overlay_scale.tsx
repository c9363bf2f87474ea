import { useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Overlay } from "../../api_types";
import { keepDraft, loadDraft } from "../../drafts";
import { useText } from "../../i18n";
import { dragOn } from "../../map/drag_gesture";
import type { XY } from "../../map/geometry";
import { fromLatLon, overlayNumbers } from "../../map/mercator";
import type { PhotoMap } from "../../map/photo_map";
import { PhotoView } from "../../map/photo_view";
import { about, apply as applyTo, compose, scaleOf, type Similarity } from "../../map/similarity";
import { NumberField } from "../../ui/number_pad";
import { Tool } from "../../ui/tool";
import { FetchTiles } from "./fetch_tiles";
import type { ScaleWay } from "./scale_step";
import { useMeasure } from "./use_measure";
import { useTiles } from "./use_tiles";
import { Verdict } from "./verdict";

type Numbers = ReturnType<typeof overlayNumbers>;

/** Where the drawing lies at first: at its known place, or filling most of the photograph's view. */
function firstPlace(site: ScaleWay["site"], map: PhotoMap): Similarity {
  const { width_px: w, height_px: h } = site.drawing ?? { width_px: 1, height_px: 1 };
  const [x, y] = map.middle;
  const unit = site.scale ? site.scale.m_per_px / Math.cos((site.georeference?.latitude_deg ?? 0) * (Math.PI / 180)) : (400 * map.nativeResolution) / Math.max(w, h);
  const g = site.georeference;
  if (!g) return { a: unit, b: 0, tx: x - (unit * w) / 2, ty: y + (unit * h) / 2 };
  const angle = (g.enu_from_map_yaw_deg * Math.PI) / 180;
  const turned: Similarity = { a: unit * Math.cos(angle), b: unit * Math.sin(angle), tx: 0, ty: 0 };
  const corner = applyTo(turned, [0, -h]);  // the Map origin: the lower left corner
  const [ox, oy] = fromLatLon(g.latitude_deg, g.longitude_deg);
  return { ...turned, tx: ox - corner[0], ty: oy - corner[1] };
}

/** The drawing laid over the photograph by dragging, turning and stretching; Z_m and Z_p shown and settable. */
export function OverlayScale({ site, ways, finish }: ScaleWay) {
  const t = useText();
  const { info, key, load } = useTiles();
  const [moving, setMoving] = useState(true);
  const [numbers, setNumbers] = useState<Numbers | null>(null);
  const photo = useRef<PhotoMap | null>(null);
  const placed = useRef<Similarity | null>(null);
  const state = useRef({ moving });
  state.current.moving = moving;
  const size: XY = [site.drawing?.width_px ?? 1, site.drawing?.height_px ?? 1];
  const middle = (): XY => applyTo(placed.current ?? { a: 1, b: 0, tx: 0, ty: 0 }, [size[0] / 2, -size[1] / 2]);
  const corner = (): XY => applyTo(placed.current ?? { a: 1, b: 0, tx: 0, ty: 0 }, [size[0], 0]);

  const measure = () => {
    const map = photo.current;
    if (!map || !placed.current || !info) return;
    const resolution = map.map.getView().getResolution() ?? 1;
    setNumbers(overlayNumbers(placed.current, [size[0] / 2, size[1] / 2], resolution, info.zoom, info.tile_px));
  };
  const put = (next: Similarity) => {
    placed.current = next;
    keepDraft(site.name, "overlay", { revision: site.drawing?.file ?? "", value: next });
    photo.current?.place(next);
    measure();
  };
  const ready = (map: PhotoMap) => {
    photo.current = map;
    const draft = loadDraft<Similarity>(site.name, "overlay");
    void map.loadDrawing(api.drawingUrl(site.walls_revision), size[0]);
    put(draft && draft.revision === site.drawing?.file ? draft.value : firstPlace(site, map));
    map.map.on("moveend", measure);
    return dragOn(map.map, {
      middle: () => (state.current.moving ? middle() : null),
      handle: corner,
      rigid: false,
      moved: (by) => placed.current && put(compose(by, placed.current)),
    });
  };
  const turn = (degrees: number) => placed.current && put(compose(about(middle(), (degrees * Math.PI) / 180), placed.current));
  const stretch = (factor: number) => placed.current && put(compose(about(middle(), 0, factor), placed.current));
  const setPhotoZoom = (value: number) => {
    const map = photo.current;
    map?.map.getView().setResolution(map.nativeResolution / value);
    measure();
  };
  const overlay: Overlay | null = numbers && info && {
    zoom: info.zoom, tile_px: info.tile_px, latitude_deg: numbers.latitude, longitude_deg: numbers.longitude,
    layout_zoom: numbers.layout_zoom, photo_zoom: numbers.photo_zoom, rotation_deg: numbers.rotation_deg, east_m: 0, north_m: 0,
    u: size[0] / 2, v: size[1] / 2,
  };
  const { result, apply } = useMeasure(overlay && { overlay });
  if (!info) return <><div class="map" /><aside>{ways}<FetchTiles site={site} done={load} /></aside></>;
  return (
    <>
      <PhotoView key={key} site={site.name} info={info} ready={ready} />
      <aside>
        {ways}
        <p class="quiet">{t("scale.overlay.hint")}</p>
        <div class="buttons">
          <Tool icon="move" label={t("scale.overlay.drawing")} pressed={moving} onClick={() => setMoving(true)} />
          <Tool icon="photo" label={t("scale.overlay.view")} pressed={!moving} onClick={() => setMoving(false)} />
        </div>
        <div class="buttons">
          <Tool icon="left" label={t("scale.turn.left")} onClick={() => turn(0.5)} />
          <Tool icon="right" label={t("scale.turn.right")} onClick={() => turn(-0.5)} />
          <Tool icon="plus" label={t("scale.larger")} onClick={() => stretch(1.005)} />
          <Tool icon="minus" label={t("scale.smaller")} onClick={() => stretch(1 / 1.005)} />
        </div>
        {numbers && (
          <div class="buttons">
            <NumberField label={t("scale.zm")} value={Number(numbers.layout_zoom.toPrecision(5))} least={0.001} most={1000}
              change={(value) => value !== null && stretch(value / ((scaleOf(placed.current ?? { a: 1, b: 0, tx: 0, ty: 0 })) / (photo.current?.map.getView().getResolution() ?? 1)))} />
            <NumberField label={t("scale.zp")} value={Number(numbers.photo_zoom.toPrecision(5))} least={0.2} most={60} change={(value) => value !== null && setPhotoZoom(value)} />
          </div>
        )}
        {result && <Verdict site={site} result={result} />}
        <span class="spring" />
        {finish(result, apply)}
      </aside>
    </>
  );
}

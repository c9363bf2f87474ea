import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { RevisionPreview, Routes, Site, Walls } from "../../api_types";
import { useText } from "../../i18n";
import { dragOn } from "../../map/drag_gesture";
import type { FactoryMap } from "../../map/factory_map";
import type { XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { showRevision } from "../../map/revision_layer";
import { angleOf, apply, compose, identity, scaleOf, type Similarity } from "../../map/similarity";
import { Question } from "../../ui/question";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";
import { faultyOf } from "./route_edit";
import { Findings } from "./findings";

const kHandle_px = 110;

/** The middle of what is drawn. */
function middleOf(pieces: RevisionPreview["drawn"]): XY {
  const sum = pieces.reduce<XY>(([x, y], [x1, y1, x2, y2]) => [x + x1 + x2, y + y1 + y2], [0, 0]);
  const count = 2 * Math.max(1, pieces.length);
  return [sum[0] / count, sum[1] / count];
}

/** Fingers move the new drawing on the old one: how far, until it is laid there. */
function useMoving(preview: RevisionPreview, laid: (preview: RevisionPreview) => void) {
  const [by, setBy] = useState<Similarity | null>(null);
  const now = useRef({ by, preview });
  now.current = { by, preview };
  const attach = ({ map }: FactoryMap) => {
    const middle = () => (now.current.by ? apply(now.current.by, middleOf(now.current.preview.drawn)) : null);
    return dragOn(map, {
      middle,
      handle: () => {
        const [x, y] = middle() ?? [0, 0];
        return [x + kHandle_px * (map.getView().getResolution() ?? 1), y];
      },
      rigid: false,
      moved: (step) => setBy((old) => old && compose(step, old)),
    });
  };
  const toggle = () => {
    if (!by) return setBy(identity);
    void attempt(async () => laid(await api.movePreview({ scale: scaleOf(by), yaw: angleOf(by), x: by.tx, y: by.ty }))).then(() => setBy(null));
  };
  return { by, attach, toggle };
}

interface Props {
  site: Site;
  walls: Walls;
  routes: Routes;
  /** the drawing's file name */
  name: string;
  preview: RevisionPreview;
  laid: (preview: RevisionPreview) => void;
  /** the site is to take the drawing over as a new one, without the old one's scale */
  asNew: () => void;
  /** ends it; true where the new drawing is the site's now */
  close: (taken: boolean) => void;
}

/** What a new revision of the drawing changes, before it does: walls gone and new, routes kept and checked anew. */
export function RevisionView({ site, walls, routes, name, preview, laid, asNew, close }: Props) {
  const t = useText();
  const map = useRef<FactoryMap | null>(null);
  const moving = useMoving(preview, laid);
  const [asks, setAsks] = useState(false);
  useEffect(() => {
    if (map.current) showRevision(map.current.sketch, preview, moving.by);
  }, [preview, moving.by]);
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.showRoutes(routes, [], faultyOf(preview.findings));
    showRevision(made.sketch, preview, null);
    made.fitWalls([made.sketch]);
    return moving.attach(made);
  };
  const leave = () => void api.dropPreview().then(() => close(false), () => close(false));
  const take = () => void attempt(api.applyPreview).then((good) => good && close(true));
  const m = (length: number) => length.toFixed(1);
  const lost = preview.stations_lost;
  const legend = (
    <ul class="legend" aria-label={t("legend.walls")}>
      <li><i class="wall-gone" />{t("revision.gone")}</li><li><i class="wall-added" />{t("revision.added")}</li>
    </ul>
  );
  return (
    <>
      <MapView ready={ready} above={legend} />
      <aside class="revision" data-gone={preview.gone.length} data-added={preview.added.length}>
        <p class="facts">{t("revision.title", { name })}</p>
        <p role="status">{t("revision.changes", { gone: m(preview.gone_m), added: m(preview.added_m), percent: (100 * preview.laid.covered).toFixed(0) })}</p>
        {routes.nodes.length > 0 && <><p>{t("revision.routes")}</p><Findings findings={preview.findings} good={t("revision.routes_good")} /></>}
        {lost.length > 0 && <p class="caution" data-lost={lost.join()}>{t("revision.lost", { stations: lost.join(", ") })}</p>}
        <p class="quiet">{t(moving.by ? "revision.hint.move" : "revision.hint")}</p>
        <div class="buttons">
          <Tool icon="hand" label={t(moving.by ? "revision.lay" : "revision.move")} pressed={moving.by !== null} onClick={moving.toggle} />
          <Tool icon="file" label={t("revision.as_new")} onClick={() => setAsks(true)} />
        </div>
        <span class="spring" />
        <div class="buttons finish">
          <Tool icon="good" label={t("revision.take")} primary disabled={moving.by !== null} onClick={take} />
          <Tool icon="back" label={t("question.no")} onClick={leave} />
        </div>
        {asks && <Question text={t("drawing.question", { name })} yes={t("drawing.replace.yes")} answer={(yes) => { setAsks(false); if (yes) asNew(); }} />}
      </aside>
    </>
  );
}

import type { ComponentChildren } from "preact";
import { api } from "../../api";
import type { Hypothesis, Site, Walls } from "../../api_types";
import { figure } from "../../figures";
import { useText } from "../../i18n";
import { live } from "../../live/live_socket";
import type { FactoryMap } from "../../map/factory_map";
import { MapView } from "../../map/map_view";
import { usePlacing, type Pose } from "../../map/use_placing";
import { useSelected } from "../../store";
import { Stale } from "../../ui/stale";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";

const degrees = (yaw: number) => figure((yaw * 180) / Math.PI, 0);

function PlaceText({ pose, children }: { pose: Pose; children?: ComponentChildren }) {
  const t = useText();
  return <span>{t("locate.place", { x: figure(pose.x, 1), y: figure(pose.y, 1), yaw: degrees(pose.yaw) })}{children}</span>;
}

function Places(props: { places: readonly Hypothesis[]; chosen: number; choose: (index: number) => void }) {
  const t = useText();
  return (
    <ol class="places" aria-label={t("locate.places")}>
      {props.places.slice(0, 5).map((place, i) => (
        <li key={i}>
          <button type="button" class="target row" aria-pressed={i === props.chosen} onClick={() => props.choose(i)}>
            <b>{i + 1}</b>
            <PlaceText pose={place}>
              <meter min={0} max={1} value={place.score} aria-label={t("drive.score")} />
              <small>{t("locate.score", { score: (100 * place.score).toFixed(0) })}</small>
            </PlaceText>
          </button>
        </li>
      ))}
    </ol>
  );
}

/** Step 5: ranked places, each with the live scan laid over the walls; one tap accepts, or the pose is dragged. */
export function LocateStep({ site, walls, finished }: { site: Site; walls: Walls; finished: () => void }) {
  const t = useText();
  const placing = usePlacing(site, walls.walls, true);
  const drivable = useSelected(live.newest, (frame) => frame?.live.drivable ?? false);
  const { locate, byHand, pose, fit } = placing;
  const ready = (made: FactoryMap) => {
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.fitWalls();
    return placing.attach(made);
  };
  const accept = () => {
    if (!pose) return;
    void attempt(() => api.setPose({ x: pose.x, y: pose.y, yaw: pose.yaw })).then((good) => good && finished());
  };
  const contradicted = fit?.contradicted.length ?? 0;
  return (
    <>
      <MapView ready={ready} above={byHand && <p class="banner card" role="status">{t("locate.hint.hand")}</p>} />
      <aside>
        <p class="facts" role="status" data-locate={locate?.state ?? ""}>{locate ? t(`locate.state.${locate.state}`) : "…"} <Stale age={placing.age_s} limit={3} /></p>
        {!byHand && <Places places={placing.places} chosen={placing.chosen} choose={placing.choose} />}
        {byHand && <p class="quiet"><PlaceText pose={byHand} /></p>}
        {contradicted > 0 && <p class="bad" data-contradicted={contradicted}>{t("where.contradicted", { count: contradicted })}</p>}
        <div class="buttons">
          <Tool icon="hand" label={t("locate.by_hand")} pressed={byHand !== null} onClick={placing.toggleHand} />
          <Tool icon="search" label={t("locate.again")} onClick={() => void attempt(api.searchAnew).then(placing.refresh)} />
        </div>
        <span class="spring" />
        <div class="buttons finish">
          <Tool icon="good" label={t("locate.accept")} primary disabled={pose === null} onClick={accept} />
          <Tool icon="next" label={t("setup.next")} disabled={!drivable} onClick={finished} />
        </div>
      </aside>
    </>
  );
}

import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { Hypothesis, Site, Walls } from "../../api_types";
import { useText } from "../../i18n";
import { live } from "../../live/live_socket";
import { dragOn } from "../../map/drag_gesture";
import type { FactoryMap } from "../../map/factory_map";
import type { XY } from "../../map/geometry";
import { MapView } from "../../map/map_view";
import { angleOf, apply, type Similarity } from "../../map/similarity";
import { usePolled, useStore } from "../../store";
import { Stale } from "../../ui/stale";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";

type Pose = Pick<Hypothesis, "x" | "y" | "yaw">;
const kHandle_px = 110;

const moved = (pose: Pose, by: Similarity): Pose => {
  const [x, y] = apply(by, [pose.x, pose.y]);
  return { x, y, yaw: pose.yaw + angleOf(by) };
};

function Places(props: { places: readonly Hypothesis[]; chosen: number; choose: (index: number) => void }) {
  const t = useText();
  return (
    <ol class="places" aria-label={t("locate.places")}>
      {props.places.slice(0, 5).map((place, i) => (
        <li key={i}>
          <button type="button" class="target row" aria-pressed={i === props.chosen} onClick={() => props.choose(i)}>
            <b>{i + 1}</b>
            <span>
              {t("locate.place", { x: place.x.toFixed(1), y: place.y.toFixed(1), yaw: ((place.yaw * 180) / Math.PI).toFixed(0) })}
              <meter min={0} max={1} value={place.score} aria-label={t("drive.score")} />
              <small>{t("locate.score", { score: (100 * place.score).toFixed(0) })}</small>
            </span>
          </button>
        </li>
      ))}
    </ol>
  );
}

/** Step 5: ranked places, each with the live scan laid over the walls; one tap accepts, or the pose is dragged. */
export function LocateStep({ site, walls, finished }: { site: Site; walls: Walls; finished: () => void }) {
  const t = useText();
  const { value: locate, refresh, age_s } = usePolled(api.locate, 1000);
  const [chosen, setChosen] = useState(0);
  const [byHand, setByHand] = useState<Pose | null>(null);
  const map = useRef<FactoryMap | null>(null);
  const frame = useStore(live.newest);
  const places = locate?.hypotheses ?? [];
  const pose: Pose | null = byHand ?? places[chosen] ?? places[0] ?? null;
  const now = useRef({ byHand, pose });
  now.current = { byHand, pose };
  useEffect(() => {
    const scan = live.newest.value?.scan;
    if (!map.current || !scan) return;
    if (pose) map.current.live.show({ scan, scanAt: pose, live: null, vehicle: site.vehicle, stale: false });
  }, [frame, pose?.x, pose?.y, pose?.yaw]);
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.fitWalls();
    const reach = () => kHandle_px * (made.map.getView().getResolution() ?? 1);
    const handle = (): XY => {
      const at = now.current.byHand ?? { x: 0, y: 0, yaw: 0 };
      return [at.x + reach() * Math.cos(at.yaw), at.y + reach() * Math.sin(at.yaw)];
    };
    return dragOn(made.map, {
      middle: () => (now.current.byHand ? [now.current.byHand.x, now.current.byHand.y] : null),
      handle,
      rigid: true,
      moved: (by) => setByHand((old) => old && moved(old, by)),
    });
  };
  const startByHand = () => {
    const [x, y] = map.current?.map.getView().getCenter() ?? [0, 0];
    setByHand(byHand ? null : (pose ?? { x: x ?? 0, y: y ?? 0, yaw: 0 }));
  };
  const accept = () => {
    if (!pose) return;
    void attempt(() => api.setPose({ x: pose.x, y: pose.y, yaw: pose.yaw })).then((good) => good && finished());
  };
  return (
    <>
      <MapView ready={ready} above={byHand && <p class="banner card" role="status">{t("locate.hint.hand")}</p>} />
      <aside>
        <p class="facts" role="status" data-locate={locate?.state ?? ""}>{t(`locate.state.${locate?.state ?? "blind"}`)} <Stale age={age_s} limit={3} /></p>
        {!byHand && <Places places={places} chosen={chosen} choose={setChosen} />}
        {byHand && <p class="quiet">{t("locate.place", { x: byHand.x.toFixed(1), y: byHand.y.toFixed(1), yaw: ((byHand.yaw * 180) / Math.PI).toFixed(0) })}</p>}
        <div class="buttons">
          <Tool icon="hand" label={t("locate.by_hand")} pressed={byHand !== null} onClick={startByHand} />
          <Tool icon="search" label={t("locate.again")} onClick={() => void attempt(api.searchAnew).then(refresh)} />
        </div>
        <span class="spring" />
        <div class="buttons finish">
          <Tool icon="good" label={t("locate.accept")} primary disabled={pose === null} onClick={accept} />
          <Tool icon="next" label={t("setup.next")} disabled={!frame?.live.drivable} onClick={finished} />
        </div>
      </aside>
    </>
  );
}

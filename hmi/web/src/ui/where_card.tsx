import { useState } from "preact/hooks";
import { api } from "../api";
import type { Session, Walls } from "../api_types";
import { distanceToSegment } from "../map/geometry";
import type { Placing } from "../map/use_placing";
import { noticeText, useText } from "../i18n";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { Stale } from "./stale";
import { attempt, tell } from "./toast";
import { Tool } from "./tool";

const kSame_m = 0.05;

/** The drawn walls without those that hold one of the pieces. */
function without(walls: readonly number[][], pieces: readonly number[][]): number[][] {
  const holds = (wall: readonly number[], [x1 = 0, y1 = 0, x2 = 0, y2 = 0]: readonly number[]) => {
    const line = wall.slice(0, 4) as [number, number, number, number];
    return distanceToSegment([(x1 + x2) / 2, (y1 + y2) / 2], line) < kSame_m;
  };
  return walls.filter((wall) => !pieces.some((piece) => holds(wall, piece)));
}

/** What became of the place that was said last. */
function Said() {
  const t = useText();
  const frame = useStore(live.newest);
  const pose = frame?.live.pose;
  if (!pose) return null;
  const good = pose.health === "LOCALIZED" || pose.health === "DEGRADED";
  const { cause } = frame.live;
  const why = ["place-unknown", "place-ambiguous"].includes(cause.code) ? noticeText(t, "cause", cause) : t("where.waiting");
  return <p class={good ? "card" : "card bad"} role="status" data-said={good ? "agreed" : "open"}>{good ? t("where.agreed") : why}</p>;
}

/** "Where am I?": ranked places laid on the map, the scan dragged onto the walls, and what to do where a wall contradicts. */
export function WhereCard(props: { placing: Placing; role: Session["role"]; walls: Walls; changed: () => void; close: () => void }) {
  const t = useText();
  const { placing, role, walls } = props;
  const { locate, places, chosen, byHand, pose, fit } = placing;
  const [said, setSaid] = useState(false);
  const may = role === "operator" || role === "integrator";
  const contradicted = fit?.contradicted ?? [];
  const say = (insist: boolean) => {
    if (!pose) return;
    const { x, y, yaw } = pose;
    void attempt(() => api.setPose(insist ? { x, y, yaw, insist } : { x, y, yaw })).then((good) => good && setSaid(true));
  };
  const erase = () => {
    const left = without(walls.walls, contradicted).map((wall) => wall.slice(0, 4) as [number, number, number, number]);
    void attempt(() => api.saveWalls({ revision: walls.revision, walls: left })).then((good) => good && props.changed());
  };
  const report = () => {
    if (!pose) return;
    void attempt(() => api.report({ x: pose.x, y: pose.y, yaw: pose.yaw, walls: contradicted.length })).then((good) => good && tell("told", t("where.told")));
  };
  return (
    <section class="where" aria-label={t("where.title")}>
      <p class="facts" role="status" data-locate={locate?.state ?? ""}>{locate ? t(`locate.state.${locate.state}`) : "…"} <Stale age={placing.age_s} limit={3} /></p>
      {!byHand && places.length > 0 && (
        <div class="buttons" role="group" aria-label={t("locate.places")}>
          {places.slice(0, 3).map((place, i) => (
            <button key={i} type="button" class="target field" aria-pressed={i === chosen} onClick={() => placing.choose(i)}>
              <span>{i + 1}</span><small>{t("unit.percent", { value: (100 * place.score).toFixed(0) })}</small>
            </button>
          ))}
        </div>
      )}
      <div class="buttons">
        {may && <Tool icon="good" label={t("locate.accept")} primary disabled={pose === null} onClick={() => say(false)} />}
        <Tool icon="hand" label={t("locate.by_hand")} pressed={byHand !== null} onClick={placing.toggleHand} />
        {may && <Tool icon="search" label={t("locate.again")} onClick={() => void attempt(api.searchAnew).then(placing.refresh)} />}
      </div>
      {said && <Said />}
      <p class={contradicted.length > 0 ? "bad" : "quiet"} data-contradicted={contradicted.length}>
        {fit === null && t("where.no_scan")}
        {fit && byHand && <span>{t("where.on_walls", { share: (100 * fit.share).toFixed(0) })} </span>}
        {contradicted.length > 0 && t("where.contradicted", { count: contradicted.length })}
      </p>
      <div class="buttons">
        {may && <Tool icon="pin" label={t("where.anyway")} disabled={pose === null} onClick={() => say(true)} />}
        {role === "integrator" && contradicted.length > 0 && <Tool icon="erase" label={t("where.erase")} onClick={erase} />}
        {may && <Tool icon="file" label={t("where.report")} disabled={pose === null} onClick={report} />}
        <Tool icon="back" label={t("where.close")} onClick={props.close} />
      </div>
    </section>
  );
}

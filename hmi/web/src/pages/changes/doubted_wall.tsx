import { useState } from "preact/hooks";
import { api } from "../../api";
import type { DoubtedWall, Session, Walls } from "../../api_types";
import { useText } from "../../i18n";
import { cutOut } from "../../map/cut_walls";
import { Icon } from "../../ui/icon";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";

type Rows = [number, number, number, number][];
const rowsOf = (walls: readonly (readonly number[])[]): Rows => walls.map(([x1 = 0, y1 = 0, x2 = 0, y2 = 0]) => [x1, y1, x2, y2]);

export interface TakenOut {
  /** the walls before, and the revision that they became */
  walls: Rows;
  revision: string;
  length_m: number;
}

/** "Is this wall gone for good?", with its answers once it was touched; `place`: the how manyth of how many questions it is. */
export function DoubtRow(props: { wall: DoubtedWall; place: [number, number]; walls: Walls; role: Session["role"]; chosen: boolean; choose: () => void; gone: (taken: TakenOut) => void; stands: () => void; later: () => void }) {
  const t = useText();
  const { wall, place, walls, role, chosen } = props;
  const [busy, setBusy] = useState(false);
  const once = (action: () => Promise<unknown>) => {
    setBusy(true);
    void attempt(action).then(() => setBusy(false));
  };
  const takeOut = () => once(async () => {
    const { revision } = await api.saveWalls({ revision: walls.revision, walls: rowsOf(cutOut(walls.walls, wall.segments)) });
    props.gone({ walls: rowsOf(walls.walls), revision, length_m: wall.length_m });
  });
  const keep = () => once(async () => {
    await api.wallStands({ segments: wall.segments });
    props.stands();
  });
  return (
    <li data-doubts={place[1]}>
      <button type="button" class="target row" aria-pressed={chosen} onClick={props.choose}>
        <Icon name="warning" />
        <span><strong>{t("doubt.question")}</strong><small>{t("doubt.facts", { metres: wall.length_m.toFixed(1), looks: Math.round(wall.looks) })}{place[1] > 1 && ` (${place.join("/")})`}</small></span>
      </button>
      {chosen && role === "viewer" && <p class="quiet">{t("doubt.needs_operator")}</p>}
      {chosen && role !== "viewer" && (
        <div class="buttons">
          {role === "integrator" && <Tool icon="erase" label={t("doubt.gone")} disabled={busy} onClick={takeOut} />}
          <Tool icon="good" label={t("doubt.stands")} disabled={busy} onClick={keep} />
          {place[1] > 1 && <Tool icon="next" label={t("doubt.later")} onClick={props.later} />}
        </div>
      )}
    </li>
  );
}

/** What was taken out a moment ago, and its way back. */
export function TakenOutCard({ taken, done }: { taken: TakenOut; done: () => void }) {
  const t = useText();
  const back = () => void attempt(() => api.saveWalls({ revision: taken.revision, walls: taken.walls })).then((good) => good && done());
  return (
    <div class="card taken-out" role="status">
      <p>{t("doubt.taken", { metres: taken.length_m.toFixed(1) })}</p>
      <div class="buttons"><Tool icon="undo" label={t("doubt.back")} onClick={back} /></div>
    </div>
  );
}

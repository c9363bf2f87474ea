import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../../api";
import type { DayChange, DoubtedWall, Session } from "../../api_types";
import type { Content } from "../../content";
import { language, useText } from "../../i18n";
import { extentOfChange, extentOfWall, showChanges } from "../../map/change_layer";
import { DayLayer, dayColours } from "../../map/day_layer";
import type { FactoryMap } from "../../map/factory_map";
import { MapView } from "../../map/map_view";
import { usePolled, useStore } from "../../store";
import type { IconName } from "../../ui/icon";
import { Stale } from "../../ui/stale";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";
import { ChangeRow, dateAndAge } from "./change_row";
import { baseDate, dateText, type Base } from "./day_choice";
import { DoubtRow, TakenOutCard, type TakenOut } from "./doubted_wall";
import { useChanges } from "./use_changes";

/** By what a row stays the chosen one while its figures change. */
const keyOf = (one: DayChange | DoubtedWall): string => JSON.stringify("segments" in one ? one.segments : one);

function Legend() {
  const t = useText();
  return (
    <ul class="legend" aria-label={t("changes.legend")}>
      {(Object.keys(dayColours) as (keyof typeof dayColours)[]).map((state) => <li key={state}><i class={`day-${dayColours[state]}`} />{t(`day.${state}`)}</li>)}
    </ul>
  );
}

/** What the chosen day, its changes and the walls in doubt look like on the map. */
function useMarks(map: { current: FactoryMap | null }, changes: readonly DayChange[], doubts: readonly DoubtedWall[], chosen: string | null) {
  const look = JSON.stringify([changes, doubts, chosen]);
  useEffect(() => {
    const one = [...changes, ...doubts].find((each) => keyOf(each) === chosen) ?? null;
    if (map.current) showChanges(map.current.sketch, changes, doubts, one);
  }, [look]);
}

/** Look back on the building: what the vehicle saw at the end of each day, and what changed between two. */
export function Changes({ site, walls, role, changed }: Content & { role: Session["role"]; changed: () => Promise<unknown> }) {
  const t = useText();
  const words = useStore(language);
  const map = useRef<FactoryMap | null>(null);
  const layer = useRef<DayLayer | null>(null);
  const { value: kept, age_s } = usePolled(api.days, 30_000);
  const { value: asked, refresh } = usePolled(api.doubtedWalls, 5000);
  const [date, setDate] = useState<string | null>(null);
  const [base, setBase] = useState<Base>({ kind: "week" });
  const [chosen, setChosen] = useState<string | null>(null);
  const [question, setQuestion] = useState("");
  const [taken, setTaken] = useState<TakenOut | null>(null);
  const days = kept?.days ?? [];
  const shown = days.find((day) => day.date === date) ?? days.at(-1) ?? null;
  const since = shown ? baseDate(days, shown.date, base) : null;
  const found = useChanges(since, shown?.date ?? null);
  const changes = since ? (found?.changes ?? []) : [];
  const doubts = asked ?? [];
  const doubt = doubts.find((wall) => keyOf(wall) === question) ?? doubts[0];
  useMarks(map, changes, doubts, chosen);
  useEffect(() => void attempt(async () => layer.current?.show(shown)), [shown?.date, shown?.extent.join()]);
  useEffect(() => map.current?.showWalls(walls.walls), [walls.revision]);
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.room = [20, 20, 130, 20];  // the slider
    made.showSite(site, site.drawing ? api.drawingUrl(site.walls_revision) : null);
    made.showWalls(walls.walls);
    made.fitWalls();
    const days_layer = new DayLayer(made);
    layer.current = days_layer;
    return () => days_layer.dispose();
  };
  const choose = (one: DayChange | DoubtedWall) => {
    setChosen(keyOf(one));
    map.current?.showPlace("segments" in one ? extentOfWall(one) : extentOfChange(one));
  };
  /** One question at a time: an old drawing may have a hundred. */
  const ask = (wall: DoubtedWall | undefined) => {
    if (!wall) return;
    setQuestion(keyOf(wall));
    choose(wall);
  };
  const edited = (now: TakenOut | null) => {
    setTaken(now);
    setChosen(null);
    void changed();
    refresh();
  };
  const count = (kind: DayChange["kind"]) => changes.filter((change) => change.kind === kind).length;
  const compare = (next: Base, label: string, icon: IconName) => <Tool icon={icon} label={label} pressed={base.kind === next.kind} onClick={() => setBase(next)} />;
  return (
    <div class="with-map changes">
      <MapView ready={ready} above={shown && <Legend />}>
        {shown && (
          <label class="day-slider">
            <span class="ends"><small>{dateText(days[0]?.date ?? shown.date, words)}</small><b role="status">{dateText(shown.date, words, true)}</b><small>{dateText(days.at(-1)?.date ?? shown.date, words)}</small></span>
            <input type="range" class="target" min={0} max={Math.max(0, days.length - 1)} step={1} value={days.indexOf(shown)} disabled={days.length < 2} aria-label={t("changes.day")}
              aria-valuetext={dateText(shown.date, words, true)} onInput={(event) => setDate(days[Number(event.currentTarget.value)]?.date ?? null)} />
          </label>
        )}
      </MapView>
      <aside>
        <Stale age={age_s} limit={75} />
        {kept && days.length === 0 && <p class="quiet" role="status">{t("changes.no_day")}</p>}
        {kept && kept.skipped.length > 0 && <p class="caution">{t("changes.skipped", { count: kept.skipped.length })}</p>}
        {shown && (
          <div class="buttons" role="group" aria-label={t("changes.against")}>
            {compare({ kind: "before" }, t("changes.day_before"), "earlier")}
            {compare({ kind: "week" }, t("changes.week_before"), "week")}
            {compare({ kind: "held", date: shown.date }, t("changes.this_day"), "pin")}
          </div>
        )}
        {shown && (
          <p class="facts" role="status" data-since={since ?? ""} data-known={found ? "yes" : "no"}>
            {since === null && t(base.kind === "held" ? "changes.held" : "changes.one_day", { date: dateText(shown.date, words) })}
            {since !== null && <>{t("changes.since", { date: dateAndAge(t, since, words) })}<br />{found ? t("changes.count", { gone: count("gone"), new: count("new"), moved: count("moved") }) : t("history.asking")}</>}
          </p>
        )}
        {taken && <TakenOutCard taken={taken} done={() => edited(null)} />}
        <ul class="files">
          {doubt && (
            <DoubtRow key={keyOf(doubt)} wall={doubt} place={[doubts.indexOf(doubt) + 1, doubts.length]} walls={walls} role={role} chosen={keyOf(doubt) === chosen} choose={() => choose(doubt)}
              gone={edited} stands={() => edited(taken)} later={() => ask(doubts[(doubts.indexOf(doubt) + 1) % doubts.length])} />
          )}
          {changes.map((change) => <ChangeRow key={keyOf(change)} change={change} chosen={keyOf(change) === chosen} choose={() => choose(change)} />)}
        </ul>
        {kept && kept.of_other_frames > 0 && <p class="quiet">{t("changes.other_frames", { count: kept.of_other_frames })}</p>}
      </aside>
    </div>
  );
}

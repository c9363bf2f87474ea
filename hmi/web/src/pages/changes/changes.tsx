import { useState } from "preact/hooks";
import { api } from "../../api";
import type { DayChange, DoubtedWall, KeptDays, Session } from "../../api_types";
import type { Content } from "../../content";
import { useText } from "../../i18n";
import { usePolled } from "../../store";
import { Stale } from "../../ui/stale";
import { ChangeRow } from "./change_row";
import { ChangesMap } from "./changes_map";
import { keyOf, nothingChosen, type Listed } from "./chosen";
import { Compare } from "./compare";
import { baseDate, type Base } from "./day_choice";
import { DaySlider } from "./day_slider";
import { DoubtRow, TakenOutCard, type TakenOut } from "./doubted_wall";
import { useChanges } from "./use_changes";

/** The day that is shown, the one that it is compared with, and what changed between them. */
function useDays() {
  const { value: kept, age_s } = usePolled(api.days, 30_000);
  const [date, choose] = useState<string | null>(null);
  const [base, setBase] = useState<Base>({ kind: "week" });
  const days = kept?.days ?? [];
  const shown = days.find((day) => day.date === date) ?? days.at(-1) ?? null;
  const since = shown ? baseDate(days, shown.date, base) : null;
  const found = useChanges(since, shown?.date ?? null);
  return { kept, age_s, days, shown, choose, base, setBase, since, found: since ? found : null };
}

/** Walls that a person is asked about, one at a time, for an old drawing may have a hundred; and what was taken out a moment ago. */
function useDoubts(show: (one: Listed | null) => void, changed: () => Promise<unknown>) {
  const { value, refresh } = usePolled(api.doubtedWalls, 5000);
  const [question, setQuestion] = useState("");
  const [taken, setTaken] = useState<TakenOut | null>(null);
  const walls: readonly DoubtedWall[] = value ?? [];
  const at = Math.max(0, walls.findIndex((wall) => keyOf(wall) === question));
  const later = () => {
    const next = walls[(at + 1) % walls.length];
    if (!next) return;
    setQuestion(keyOf(next));
    show(next);
  };
  const edited = (now: TakenOut | null) => {
    setTaken(now);
    show(null);
    void changed();
    refresh();
  };
  return { walls, at, taken, later, edited };
}

/** Why days are not among those that can be shown. */
function LeftOut({ kept }: { kept: KeptDays }) {
  const t = useText();
  return (
    <>
      {kept.days.length === 0 && <p class="quiet" role="status">{t("changes.no_day")}</p>}
      {kept.skipped.length > 0 && <p class="caution">{t("changes.skipped", { count: kept.skipped.length })}</p>}
      {kept.of_other_frames > 0 && <p class="quiet">{t("changes.other_frames", { count: kept.of_other_frames })}</p>}
    </>
  );
}

/** Look back on the building: what the vehicle saw at the end of each day, and what changed between two. */
export function Changes({ site, walls, role, changed }: Content & { role: Session["role"]; changed: () => Promise<unknown> }) {
  const [chosen, setChosen] = useState(nothingChosen);
  const choose = (one: Listed | null) => setChosen((old) => ({ key: one ? keyOf(one) : "", touched: old.touched + 1 }));
  const { kept, age_s, days, shown, base, since, found, ...day } = useDays();
  const { walls: doubts, at, taken, later, edited } = useDoubts(choose, changed);
  const changes: readonly DayChange[] = found?.changes ?? [];
  const doubt = doubts[at];
  return (
    <div class="with-map changes">
      <ChangesMap site={site} walls={walls} day={shown} changes={changes} doubts={doubts} chosen={chosen}>
        {shown && <DaySlider days={days} shown={shown} choose={day.choose} />}
      </ChangesMap>
      <aside>
        <Stale age={age_s} limit={75} />
        {shown && <Compare shown={shown.date} base={base} since={since} found={found} choose={day.setBase} />}
        {taken && <TakenOutCard taken={taken} done={() => edited(null)} />}
        <ul class="files">
          {doubt && (
            <DoubtRow key={keyOf(doubt)} wall={doubt} place={[at + 1, doubts.length]} walls={walls} role={role} chosen={keyOf(doubt) === chosen.key} choose={() => choose(doubt)}
              gone={edited} stands={() => edited(taken)} later={later} />
          )}
          {changes.map((change) => <ChangeRow key={keyOf(change)} change={change} chosen={keyOf(change) === chosen.key} choose={() => choose(change)} />)}
        </ul>
        {kept && <LeftOut kept={kept} />}
      </aside>
    </div>
  );
}

import type { DayChange, DayChanges } from "../../api_types";
import { language, useText } from "../../i18n";
import { useStore } from "../../store";
import type { IconName } from "../../ui/icon";
import { Tool } from "../../ui/tool";
import { dateAndAge } from "./change_row";
import { dateText, type Base } from "./day_choice";

/** With which day the shown one is compared, and what came of it; `since`: that day, null where there is none; `found`: null while it is asked for. */
export function Compare(props: { shown: string; base: Base; since: string | null; found: DayChanges | null; choose: (base: Base) => void }) {
  const t = useText();
  const words = useStore(language);
  const { shown, base, since, found } = props;
  const tool = (next: Base, label: string, icon: IconName) => <Tool icon={icon} label={label} pressed={base.kind === next.kind} onClick={() => props.choose(next)} />;
  const count = (kind: DayChange["kind"]) => (found?.changes ?? []).filter((change) => change.kind === kind).length;
  const nothing = t(base.kind === "held" ? "changes.held" : "changes.one_day", { date: dateText(shown, words) });
  return (
    <>
      <div class="buttons" role="group" aria-label={t("changes.against")}>
        {tool({ kind: "before" }, t("changes.day_before"), "earlier")}
        {tool({ kind: "week" }, t("changes.week_before"), "week")}
        {tool({ kind: "held", date: shown }, t("changes.this_day"), "pin")}
      </div>
      <p class="facts" role="status" data-since={since ?? ""} data-known={found ? "yes" : "no"}>
        {since === null ? nothing : t("changes.since", { date: dateAndAge(t, since, words) })}
        {since !== null && <><br />{found ? t("changes.count", { gone: count("gone"), new: count("new"), moved: count("moved") }) : t("history.asking")}</>}
      </p>
    </>
  );
}

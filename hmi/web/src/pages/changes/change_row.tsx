import type { DayChange } from "../../api_types";
import { language, useText, type Translate } from "../../i18n";
import { Icon, type IconName } from "../../ui/icon";
import { useStore } from "../../store";
import { dateText, daysSince } from "./day_choice";

const kIcons: Record<DayChange["kind"], IconName> = { gone: "bad", new: "plus", moved: "next" };

/** A date and how long ago that is. */
export function dateAndAge(t: Translate, date: string, words: string): string {
  const days = daysSince(date, Date.now());
  const age = days <= 0 ? t("changes.today") : days === 1 ? t("changes.yesterday") : t("changes.days_ago", { days });
  return t("changes.date", { date: dateText(date, words), age });
}

/** One thing that changed: what, how large, since when. */
export function ChangeRow({ change, chosen, choose }: { change: DayChange; chosen: boolean; choose: () => void }) {
  const t = useText();
  const words = useStore(language);
  const { kind, width_m, height_m, from, x, y } = change;
  const when = { before: dateAndAge(t, change.before, words), since: dateAndAge(t, change.since, words) };
  const metres = from ? Math.hypot(x - from[0], y - from[1]).toFixed(1) : "";
  return (
    <li data-change={kind}>
      <button type="button" class="target row" aria-pressed={chosen} onClick={choose}>
        <Icon name={kIcons[kind]} />
        <span>
          <strong>{t(`changes.${kind}`, { metres })} {t("changes.size", { width: width_m.toFixed(1), height: height_m.toFixed(1) })}</strong>
          <small>{t(`changes.${kind}.when`, when)}</small>
        </span>
      </button>
    </li>
  );
}

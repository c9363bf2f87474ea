import type { KeptDay } from "../../api_types";
import { language, useText } from "../../i18n";
import { useStore } from "../../store";
import { dateText } from "./day_choice";

/** Goes through the days kept, from the oldest to the newest. */
export function DaySlider({ days, shown, choose }: { days: readonly KeptDay[]; shown: KeptDay; choose: (date: string) => void }) {
  const t = useText();
  const words = useStore(language);
  const date = dateText(shown.date, words, true);
  const end = (day: KeptDay | undefined) => <small>{day && dateText(day.date, words)}</small>;
  return (
    <label class="day-slider">
      <span class="ends">{end(days[0])}<b role="status">{date}</b>{end(days.at(-1))}</span>
      <input type="range" class="target" min={0} max={Math.max(0, days.length - 1)} step={1} value={days.indexOf(shown)} disabled={days.length < 2} aria-label={t("changes.day")}
        aria-valuetext={date} onInput={(event) => choose(days[Number(event.currentTarget.value)]?.date ?? shown.date)} />
    </label>
  );
}

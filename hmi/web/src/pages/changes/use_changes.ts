import { useEffect, useState } from "preact/hooks";
import { api } from "../../api";
import type { DayChanges } from "../../api_types";
import { attempt } from "../../ui/toast";

const kSettled_ms = 250; // a finger on the slider passes days that nobody asks about
const kAgain_ms = 60_000; // today's map is written at most once a minute

/** What changed between two days; null while it is asked for, and where there is nothing to compare. */
export function useChanges(from: string | null, to: string | null): DayChanges | null {
  const [known, setKnown] = useState<DayChanges | null>(null);
  useEffect(() => {
    if (!from || !to) return undefined;
    let wanted = true;
    const ask = () => void attempt(async () => {
      const answer = await api.dayChanges(from, to);
      if (wanted) setKnown(answer);
    });
    const first = setTimeout(ask, kSettled_ms);
    const again = setInterval(ask, kAgain_ms);
    return () => {
      wanted = false;
      clearTimeout(first);
      clearInterval(again);
    };
  }, [from, to]);
  const [older, newer] = [from, to].sort();
  return known && known.from === older && known.to === newer ? known : null;
}

import { useState } from "preact/hooks";
import type { Finding } from "../../api_types";
import { noticeText, useText } from "../../i18n";
import { Icon } from "../../ui/icon";

/** What a person can mend at a time; the rest would push the buttons below it off the panel. */
const kShown = 2;

/** Errors before what is only worth a look, otherwise in the order of the check. */
export const worstFirst = (findings: readonly Finding[]): Finding[] => [...findings.filter(({ severity }) => severity === "error"), ...findings.filter(({ severity }) => severity !== "error")];

/** What a check found wrong with the routes, the worst first; `good` where it found nothing. */
export function Findings({ findings, good }: { findings: readonly Finding[]; good: string }) {
  const t = useText();
  const [all, setAll] = useState(false);
  if (findings.length === 0) return <p class="quiet" role="status"><Icon name="good" /> {good}</p>;
  const folds = findings.length > kShown + 1;
  return (
    <div role="status"><ul class="findings">
      {worstFirst(findings).slice(0, folds && !all ? kShown : undefined).map((finding, i) => (
        <li key={i} class={finding.severity === "error" ? "bad" : ""}>
          <Icon name="warning" /> {noticeText(t, "finding", { code: finding.code, values: finding.values, text: finding.message })}
        </li>
      ))}
    </ul>
    {folds && <button type="button" class="target wide" aria-expanded={all} onClick={() => setAll(!all)}>{t(all ? "findings.fewer" : "findings.all", { count: findings.length })}</button>}
    </div>
  );
}

import type { Finding } from "../../api_types";
import { noticeText, useText } from "../../i18n";
import { Icon } from "../../ui/icon";

/** What a check found wrong with the routes; `good` where it found nothing. */
export function Findings({ findings, good }: { findings: readonly Finding[]; good: string }) {
  const t = useText();
  if (findings.length === 0) return <p class="quiet" role="status"><Icon name="good" /> {good}</p>;
  return (
    <div role="status"><ul class="findings">
      {findings.map((finding, i) => (
        <li key={i} class={finding.severity === "error" ? "bad" : ""}>
          <Icon name="warning" /> {noticeText(t, "finding", { code: finding.code, values: finding.values, text: finding.message })}
        </li>
      ))}
    </ul></div>
  );
}

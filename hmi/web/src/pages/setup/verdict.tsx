import type { ScaleResult } from "../../api_types";
import { useText } from "../../i18n";
import { Icon } from "../../ui/icon";

/** What to think of a scale, in words. */
export function Verdict({ result }: { result: ScaleResult }) {
  const t = useText();
  const bad = result.verdict === "refused" || result.verdict === "unverified";
  return (
    <div class={bad ? "caution" : ""} role="status">
      <h3>{bad && <Icon name="warning" />} {t(`scale.verdict.${result.verdict}`)}</h3>
      <p>{(1000 * result.m_per_px).toFixed(3)} mm/px ± {(100 * result.relative_uncertainty).toFixed(2)} %</p>
      <p>{result.text}</p>
    </div>
  );
}

/** The measurements of a fit with their residuals. */
export function Measurements(props: { labels: readonly string[]; result: ScaleResult | null; remove: (index: number) => void }) {
  const t = useText();
  return (
    <ul class="orders">
      {props.labels.map((label, i) => {
        const residual = props.result?.residuals[i];
        return (
          <li key={i}>
            <span>
              <strong>{t("scale.measurement", { number: i + 1 })}: {label}</strong>
              {residual && (
                <small class={residual.outlier ? "bad" : ""}>
                  {t("scale.residual", { residual: `${(1000 * residual.residual_m).toFixed(0)} mm` })}
                  {residual.outlier && ` – ${t("scale.outlier")}`}
                </small>
              )}
            </span>
            <button class="target" aria-label={t("scale.remove", { number: i + 1 })} onClick={() => props.remove(i)}>
              <Icon name="bin" />
            </button>
          </li>
        );
      })}
    </ul>
  );
}

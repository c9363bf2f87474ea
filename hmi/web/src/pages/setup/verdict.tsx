import type { ScaleResult, Site } from "../../api_types";
import { noticeText, useText } from "../../i18n";
import { Icon } from "../../ui/icon";

/** What to think of a scale, in words, and the published overlay's numbers that it stands for. */
export function Verdict({ site, result }: { site: Site; result: ScaleResult }) {
  const t = useText();
  const metres = (pixels: number) => (pixels * result.m_per_px).toFixed(1);
  const size = site.drawing && { width: metres(site.drawing.width_px), height: metres(site.drawing.height_px) };  // a length that is wrong by ten shows here
  const bad = result.verdict === "refused" || result.verdict === "unverified";
  return (
    <div class={bad ? "caution verdict" : "card verdict"} role="status" data-verdict={result.verdict} data-m-per-px={result.m_per_px}>
      <h3>{bad ? <Icon name="warning" /> : <Icon name="good" />} {t(`scale.verdict.${result.verdict}`)}</h3>
      <p>{t("scale.result", { scale: (1000 * result.m_per_px).toFixed(3), percent: (100 * result.relative_uncertainty).toFixed(2) })}</p>
      {size && <p data-size>{t("scale.size", size)}</p>}
      {[result.reason, ...result.notes].filter((note) => note.text !== "").map((note) => <p key={note.code + note.text}>{noticeText(t, "scale", note)}</p>)}
      {result.disagreements.map((line) => <p key={line}>{line}</p>)}
      {result.overlay && (
        <p class="quiet">{t("scale.published", { zm: result.overlay.layout_zoom.toFixed(3), zp: result.overlay.photo_zoom.toFixed(3), zoom: result.overlay.zoom })}</p>
      )}
    </div>
  );
}

/** The measurements of a fit with their residuals; every one can be taken away. */
export function Measurements(props: { labels: readonly string[]; result: ScaleResult | null; remove: (index: number) => void }) {
  const t = useText();
  return (
    <ul class="measured">
      {props.labels.map((label, i) => {
        const residual = props.result?.residuals[i];
        return (
          <li key={i}>
            <span>
              <strong>{t("scale.measurement", { number: i + 1 })}: {label}</strong>
              {residual && (
                <small class={residual.outlier ? "bad" : ""}>
                  {residual.outlier && <Icon name="warning" />}
                  {t("scale.residual", { residual: Math.abs(1000 * residual.residual_m).toFixed(0) })}
                  {residual.outlier && ` – ${t("scale.outlier")}`}
                </small>
              )}
            </span>
            <button type="button" class="target" aria-label={t("scale.remove", { number: i + 1 })} onClick={() => props.remove(i)}>
              <Icon name="bin" />
            </button>
          </li>
        );
      })}
    </ul>
  );
}

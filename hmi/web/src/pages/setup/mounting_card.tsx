import { useState } from "preact/hooks";
import { api } from "../../api";
import type { MountingRow, SensorInfo } from "../../api_types";
import { figure } from "../../figures";
import { noticeText, useText } from "../../i18n";
import type { TextKey } from "../../i18n/en";
import { usePolled } from "../../store";
import { Icon } from "../../ui/icon";
import { Question } from "../../ui/question";
import { attempt } from "../../ui/toast";
import { Tool } from "../../ui/tool";

const places: readonly ["x_m" | "y_m" | "z_m" | "yaw_deg", number, string][] = [["x_m", 3, "m"], ["y_m", 3, "m"], ["z_m", 3, "m"], ["yaw_deg", 2, "°"]];

const isKnown = (row: MountingRow, key: string) =>
  key === "z_m" ? row.height_known : key === "yaw_deg" ? row.known !== "nothing" : row.known === "all";

/** One lidar: typed against found. */
function Row({ row }: { row: MountingRow }) {
  const t = useText();
  return (
    <div class="mounting">
      <h3>{row.typed.name} ({row.typed.type})</h3>
      <table class="facts">
        <thead><tr><td /><th>{t("mounting.typed")}</th><th>{t("mounting.found")}</th><th>{t("mounting.sigma")}</th></tr></thead>
        <tbody>
          {places.map(([key, digits, unit]) => (
            <tr key={key}>
              <th>{t(`mount.${key}`)}</th>
              <td>{figure(row.typed[key], digits)} {unit}</td>
              <td>{isKnown(row, key) ? `${figure(row.found[key], digits)} ${unit}` : t("mounting.unknown")}</td>
              <td>{isKnown(row, key) && key !== "z_m" && `± ${key === "yaw_deg" ? row.sigma_deg.toFixed(2) : row.sigma_m.toFixed(3)} ${unit}`}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <p class="quiet">
        {t("mounting.residual", { mm: (row.residual_m * 1000).toFixed(0) })} {row.height_known && t("mounting.tilt", { deg: row.tilt_deg.toFixed(1) })}
      </p>
      {row.lack.code !== "" && <p class="caution" role="status"><Icon name="warning" /> {noticeText(t, "mounting", row.lack)}</p>}
    </div>
  );
}

/** Measures how the lidars hang by a short drive, and takes what was found over into the form. */
export function MountingCard({ saved, take }: { saved: boolean; take: (found: SensorInfo[]) => void }) {
  const t = useText();
  const [asks, setAsks] = useState(false);
  const [taken, setTaken] = useState(false);
  const { value, refresh } = usePolled(api.mounting, 500);
  const state = value?.state ?? "idle";
  const busy = state === "driving" || state === "computing";
  const begin = (yes: boolean) => {
    setAsks(false);
    setTaken(false);
    if (yes) void attempt(api.measureMounting).then(refresh);
  };
  return (
    <section class="measure">
      <h2>{t("mounting.title")}</h2>
      {!busy && <p class="quiet">{t("mounting.hint")}</p>}
      {busy && (
        <p role="status">
          {t(`mounting.state.${state}` as TextKey)} <progress max={1} value={value?.progress ?? 0} />
        </p>
      )}
      {value && value.notice.code !== "" && state !== "done" && <p class="caution" role="status"><Icon name="warning" /> {noticeText(t, "mounting", value.notice)}</p>}
      {state === "done" && value?.rows.map((row) => <Row key={row.typed.name} row={row} />)}
      <div class="buttons">
        {state === "driving"
          ? <Tool icon="stop" label={t("mounting.stop")} primary onClick={() => void attempt(api.stopMeasuring).then(refresh)} />
          : <Tool icon="right" label={t("mounting.measure")} disabled={busy || !saved} onClick={() => setAsks(true)} />}
        {state === "done" && value && <Tool icon="good" label={t("mounting.take")} primary onClick={() => { take(value.rows.map((row) => row.found)); setTaken(true); }} />}
      </div>
      {!saved && <p class="quiet">{t(taken ? "mounting.taken" : "mounting.save_first")}</p>}
      {asks && <Question text={t("mounting.ask")} yes={t("mounting.begin")} answer={begin} />}
    </section>
  );
}

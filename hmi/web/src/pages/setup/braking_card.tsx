import { useState } from "preact/hooks";
import { api, Refused } from "../../api";
import type { BrakingStop, VehicleInfo } from "../../api_types";
import { noticeText, useText } from "../../i18n";
import { usePolled } from "../../store";
import { Icon } from "../../ui/icon";
import { Question } from "../../ui/question";
import { Stale } from "../../ui/stale";
import { tell } from "../../ui/toast";
import { Tool } from "../../ui/tool";

type Measured = Pick<VehicleInfo, "max_deceleration_mps2" | "reaction_s" | "max_speed_mps">;

function Stops({ stops, record }: { stops: readonly BrakingStop[]; record: VehicleInfo }) {
  const t = useText();
  return (
    <table class="braking">
      <thead>
        <tr><td /><th>{t("braking.from")}</th><th>{t("vehicle.max_deceleration_mps2")}</th><th>{t("braking.latency")}</th><th>{t("braking.way")}</th></tr>
      </thead>
      <tbody>
        {stops.map((stop, i) => (
          <tr key={i}>
            <td>{t(stop.loaded ? "braking.loaded" : "braking.empty")}</td>
            <td>{stop.speed_mps.toFixed(2)} m/s</td>
            <td>{stop.deceleration_mps2.toFixed(2)} m/s²</td>
            <td>{stop.latency_s.toFixed(3)} s</td>
            <td>{stop.way_m.toFixed(2)} m</td>
          </tr>
        ))}
        <tr class="quiet">
          <td>{t("braking.record")}</td><td>{record.max_speed_mps.toFixed(2)} m/s</td><td>{record.max_deceleration_mps2.toFixed(2)} m/s²</td><td>{record.reaction_s.toFixed(3)} s</td><td />
        </tr>
      </tbody>
    </table>
  );
}

/** Drive, stop, measure: what the brakes do beside what the record says of them. */
export function BrakingCard({ record, takeOver }: { record: VehicleInfo; takeOver: (measured: Measured) => void }) {
  const t = useText();
  const [asked, setAsked] = useState<boolean | null>(null);
  const { value: now, age_s, refresh } = usePolled(api.braking, 500);
  const start = (loaded: boolean) =>
    void api.startBraking({ loaded }).then(refresh, (error: unknown) => {
      if (!(error instanceof Refused)) throw error;
      tell(error.code, error.message);
    });
  const measured = now?.verdict;
  const tooFast = measured && record.max_speed_mps > measured.allowed_mps;
  return (
    <section class="grow" data-braking={now?.running ? "running" : "stands"}>
      <h2>{t("braking.title")}</h2>
      <Stale age={age_s} limit={3} />
      <p class="quiet">{now && now.way_m > 0 ? t("braking.how", { way: now.way_m.toFixed(1) }) : t("braking.not_ready")}</p>
      <div class="buttons">
        {[false, true].map((loaded) => (
          <Tool key={String(loaded)} icon={loaded ? "box" : "ruler"} label={t(loaded ? "braking.start_loaded" : "braking.start_empty")}
            disabled={!now || now.running || now.way_m === 0} onClick={() => setAsked(loaded)} />
        ))}
        {measured && !now.running && (
          <Tool icon="save" label={t(tooFast ? "braking.take_slower" : "braking.take", { speed: measured.allowed_mps.toFixed(2) })} primary
            onClick={() => takeOver({
              max_deceleration_mps2: measured.deceleration_mps2,
              reaction_s: measured.reaction_s,
              max_speed_mps: Math.min(record.max_speed_mps, measured.allowed_mps),
            })} />
        )}
      </div>
      {now?.running && <p role="status">{t("braking.running", { done: now.stops_now, all: now.stops_wanted })}</p>}
      {now && !now.running && now.trouble.text !== "" && <p class="caution" role="alert"><Icon name="warning" /> {noticeText(t, "braking", now.trouble)}</p>}
      {now && now.stops.length > 0 && <Stops stops={now.stops} record={record} />}
      {measured && <p class="facts">{t("braking.verdict", { deceleration: measured.deceleration_mps2.toFixed(2), reaction: measured.reaction_s.toFixed(2) })}</p>}
      {tooFast && (
        <p class="caution" role="alert">
          <Icon name="warning" /> {t("braking.too_fast", { speed: record.max_speed_mps.toFixed(2), needs: measured.needs_m.toFixed(2), sees: measured.sees_m.toFixed(2) })}
        </p>
      )}
      {asked !== null && (
        <Question text={t("braking.question", { way: (now?.way_m ?? 0).toFixed(1) })} yes={t("braking.yes")}
          answer={(yes) => { setAsked(null); if (yes) start(asked); }} />
      )}
    </section>
  );
}

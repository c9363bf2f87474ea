import type { ComponentChildren } from "preact";
import { useText } from "../i18n";
import type { Frame } from "../live/live_socket";
import { Icon } from "./icon";
import { Stale, STALE_S, useAge } from "./stale";

/** Two standard deviations of the worse direction, metres. */
export function accuracyOf([xx = 0, xy = 0, yy = 0]: readonly number[]): number {
  return 2 * Math.sqrt(Math.max(0, (xx + yy) / 2 + Math.hypot((xx - yy) / 2, xy)));
}

function Gauge(props: { name: string; bad?: boolean; children: ComponentChildren }) {
  return (
    <div class={props.bad ? "gauge bad" : "gauge"}>
      <dt>{props.bad && <Icon name="warning" />}{props.name}</dt>
      <dd>{props.children}</dd>
    </div>
  );
}

/** Place, score, accuracy, speed, battery: every one says when it is stale. */
export function Gauges({ frame }: { frame: Frame | null }) {
  const t = useText();
  const age = useAge(frame);
  if (!frame) return null;
  const { pose, speed, battery, battery_v, score, odometer_m } = frame.live;
  const accuracy = accuracyOf(pose.covariance);
  const placeAge = Math.max(age, age + pose.age_s);
  const old = (value: ComponentChildren, limit = STALE_S) => <>{value} <Stale age={age} limit={limit} /></>;
  const power = battery !== null ? t("unit.percent", { value: (100 * battery).toFixed(0) }) : t("unit.volts", { value: (battery_v ?? 0).toFixed(1) });
  return (
    <dl class="gauges">
      <Gauge name={t("drive.place")} bad={pose.health !== "LOCALIZED"}>{t(`health.${pose.health}`)} <Stale age={placeAge} /></Gauge>
      {typeof score === "number" && <Gauge name={t("drive.score")} bad={score < 0.5}>{old(t("unit.percent", { value: (100 * score).toFixed(0) }))}</Gauge>}
      <Gauge name={t("drive.accuracy")} bad={accuracy > 0.5}>{old(accuracy < 100 ? t("unit.plus_minus_cm", { value: (100 * accuracy).toFixed(0) }) : "–")}</Gauge>
      <Gauge name={t("drive.speed")}>{old(t("unit.mps", { value: Math.abs(speed).toFixed(2) }))}</Gauge>
      {(battery !== null || typeof battery_v === "number") && <Gauge name={t("drive.battery")} bad={battery !== null && battery < 0.2}>{old(power)}</Gauge>}
      {typeof odometer_m === "number" && <Gauge name={t("drive.odometer")}>{old(t("unit.km", { value: (odometer_m / 1000).toFixed(2) }))}</Gauge>}
    </dl>
  );
}

import type { ComponentChildren } from "preact";
import { certainty } from "../figures";
import { useText } from "../i18n";
import type { Frame } from "../live/live_socket";
import { Icon } from "./icon";
import { Stale, STALE_S, useAge } from "./stale";

/** Two standard deviations of the worse direction, metres. */
export function accuracyOf([xx = 0, xy = 0, yy = 0]: readonly number[]): number {
  return 2 * Math.sqrt(Math.max(0, (xx + yy) / 2 + Math.hypot((xx - yy) / 2, xy)));
}

/** Seconds since a device was last heard, by the newest frame and its own age; Infinity before it ever was. */
export function heardAgo(frame: Frame | null, device: "lidar" | "drive", frameAge: number): number {
  const age = frame?.live.devices.find((one) => (device === "drive" ? one.type === "drive" : one.type !== "drive" && one.type !== "link"))?.age_s ?? Infinity;
  return age > 86_400 ? Infinity : age + frameAge;
}

/** A measured value: as long as it is young it is shown, then its age stands in its place. */
function Gauge(props: { name: string; bad?: boolean; age: number; children: ComponentChildren }) {
  const old = props.age > STALE_S;
  return (
    <div class={props.bad && !old ? "gauge bad" : "gauge"}>
      <dt>{props.bad && !old && <Icon name="warning" />}{props.name}</dt>
      <dd>{old ? <Stale age={props.age} /> : props.children}</dd>
    </div>
  );
}

/** Place (and how probable it is), score, accuracy, speed, battery: each with the age of what measured it. */
export function Gauges({ frame }: { frame: Frame | null }) {
  const t = useText();
  const age = useAge(frame);
  if (!frame) return null;
  const { pose, speed, battery_v, score, odometer_m } = frame.live;
  const accuracy = accuracyOf(pose.covariance);
  const lidar = heardAgo(frame, "lidar", age);
  const drive = heardAgo(frame, "drive", age);
  const known = pose.health !== "LOST";
  return (
    <dl class="gauges">
      <Gauge name={t("drive.place")} bad={pose.health !== "LOCALIZED"} age={known ? Math.max(lidar, age + pose.age_s) : age}>{t(`health.${pose.health}`)}{known && typeof pose.place === "number" && ` ${t("unit.percent", { value: certainty(pose.place) })}`}</Gauge>
      <Gauge name={t("drive.score")} bad={known && typeof score === "number" && score < 0.5} age={lidar}>{known && typeof score === "number" ? t("unit.percent", { value: (100 * score).toFixed(0) }) : "–"}</Gauge>
      <Gauge name={t("drive.accuracy")} bad={known && accuracy > 0.5} age={known ? Math.max(lidar, drive) : age}>{known && accuracy < 100 ? t("unit.plus_minus_cm", { value: (100 * accuracy).toFixed(0) }) : "–"}</Gauge>
      <Gauge name={t("drive.speed")} age={drive}>{typeof speed === "number" ? t("unit.mps", { value: Math.abs(speed).toFixed(2) }) : "–"}</Gauge>
      <Gauge name={t("drive.battery")} age={drive}>{typeof battery_v === "number" ? t("unit.volts", { value: battery_v.toFixed(1) }) : "–"}</Gauge>
      {typeof odometer_m === "number" && <Gauge name={t("drive.odometer")} age={age}>{t("unit.km", { value: (odometer_m / 1000).toFixed(2) })}</Gauge>}
    </dl>
  );
}

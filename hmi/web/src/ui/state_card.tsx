import { useEffect, useState } from "preact/hooks";
import { noticeText, useText } from "../i18n";
import { en, type TextKey } from "../i18n/en";
import type { Frame } from "../live/live_socket";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { Icon } from "./icon";

const STALE_S = 1.0;

/** Seconds since the newest message, counted on when none comes. */
export function useAge(frame: Frame | null): number {
  const [now, setNow] = useState(performance.now());
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 250);
    return () => clearInterval(timer);
  }, []);
  return frame ? Math.max(0, (now - frame.received_ms) / 1000) : Infinity;
}

function Stale({ age }: { age: number }) {
  const t = useText();
  return age > STALE_S ? <em class="stale">{t("live.stale", { age: age.toFixed(0) })}</em> : null;
}

const abnormal = new Set(["fault", "emergency_stop"]);
const standing = new Set(["waiting", "paused", "localizing"]);

/** The state in large words, why the vehicle stands and what to do about it. */
export function StateCard({ frame }: { frame: Frame | null }) {
  const t = useText();
  const connected = useStore(live.connected);
  const age = useAge(frame);
  if (!frame || !connected) {
    return (
      <section class="card alarm" aria-live="polite">
        <h2><Icon name="warning" /> {t("live.lost")}</h2>
        <p>{t("live.lost.mend", { age: Number.isFinite(age) ? age.toFixed(0) : "–" })}</p>
      </section>
    );
  }
  const { state, cause, remedy, since, goal } = frame.live;
  const key = `state.${state}`;
  const tone = abnormal.has(state) ? "alarm" : standing.has(state) && cause.code !== "" ? "caution" : "";
  return (
    <section class={`card ${tone}`} aria-live="polite">
      <h2>
        {tone !== "" && <Icon name="warning" />} {key in en ? t(key as TextKey) : state}
      </h2>
      <p class="quiet">
        {goal !== "" && <span>{t("state.to", { goal })} </span>}
        {t("state.since", { time: new Date(since * 1000).toLocaleTimeString() })} <Stale age={age} />
      </p>
      {cause.text !== "" && <p class="cause">{noticeText(t, "cause", cause)}</p>}
      {remedy.text !== "" && <p class="remedy">{noticeText(t, "remedy", remedy)}</p>}
    </section>
  );
}

/** Place, score, accuracy, speed, battery: each says when it is stale. */
export function Gauges({ frame }: { frame: Frame | null }) {
  const t = useText();
  const age = useAge(frame);
  if (!frame) return null;
  const { pose, speed, battery } = frame.live;
  const accuracy = Math.sqrt(Math.max(0, (pose.covariance[0] ?? 0) + (pose.covariance[2] ?? 0)));
  const row = (name: string, value: string, bad: boolean) => (
    <div class={bad ? "gauge bad" : "gauge"}>
      <dt>{bad && <Icon name="warning" />}{name}</dt>
      <dd>{value}</dd>
    </div>
  );
  const placeAge = Math.max(age, pose.age_s);
  return (
    <dl class="card gauges">
      {row(t(`health.${pose.health}`), "", pose.health !== "LOCALIZED")}
      {pose.health_reason !== "" && <p class="remedy">{pose.health_reason}</p>}
      {row(t("drive.accuracy"), accuracy < 100 ? `±${(100 * accuracy).toFixed(1)} cm` : "–", accuracy > 0.3)}
      {row(t("drive.speed"), `${speed.toFixed(2)} m/s`, false)}
      {battery !== null && row(t("drive.battery"), `${(100 * battery).toFixed(0)} %`, battery < 0.2)}
      <Stale age={placeAge} />
    </dl>
  );
}

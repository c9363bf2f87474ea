import type { Live } from "../api_types";
import { noticeText, useText } from "../i18n";
import { en, type TextKey } from "../i18n/en";
import { timeText } from "../figures";
import { deviceName } from "../notice_text";
import type { Frame } from "../live/live_socket";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { Icon } from "./icon";
import { Stale, useAge } from "./stale";

const abnormal = new Set(["fault", "emergency_stop"]);
const standing = new Set(["waiting", "localizing"]);
/** a stay that a person may end */
const stays = new Set(["loading", "unloading", "order-stop"]);
/** remedies that ask for a button: the command bar offers that one, whatever the state */
const goesOn = new Set(["go-on", "look-and-go-on", "look-at-place", "clear-or-go-on"]);
const resumes = new Set(["resume", "manual-off", "look-and-resume", "look-at-place-and-resume"]);
export const asksGoOn = ({ cause, remedy }: Live): boolean => stays.has(cause.code) || goesOn.has(remedy.code);
export const asksResume = ({ remedy }: Live): boolean => resumes.has(remedy.code);
/** what is wanted, and no reason to look up */
const wanted = new Set(["", "paused", "stopped", "stopped-order", "no-order", "manual", "setting-up", "mapping", "mapping-stopped"]);

/** Without a message for so long there is no connection, also where the socket seems open. */
export const kLost_s = 2;

function toneOf({ state, cause }: Live): string {
  if (abnormal.has(state)) return "alarm";
  const caution = (standing.has(state) && cause.text !== "") || !wanted.has(cause.code);
  return caution && !stays.has(cause.code) ? "caution" : "";
}

/** The devices that are silent, each with how long, in every state. */
export function Silent({ frame, age }: { frame: Frame; age: number }) {
  const t = useText();
  return (
    <>
      {frame.live.devices.filter((device) => !device.healthy && device.type !== "link").map((device) => (
        <p key={device.name} class="bad" data-silent={device.type}>
          <Icon name="warning" /> {device.age_s > 86_400 ? t("device.never", { name: deviceName(t, device) }) : t("device.silent_for", { name: deviceName(t, device), age: (device.age_s + age).toFixed(0) })}
        </p>
      ))}
    </>
  );
}

/** The state in large words, why the vehicle stands, since when, and what to do about it. Always of the same height: what lies below it must not move under a finger. */
export function StateCard({ frame }: { frame: Frame | null }) {
  const t = useText();
  const connected = useStore(live.connected);
  const age = useAge(frame);
  if (!frame || !connected || age > kLost_s) {
    return (
      <section class="card state alarm" aria-live="polite" tabIndex={0} data-connection="lost">
        <h2><Icon name="warning" /> {t("live.lost")}</h2>
        <p>{Number.isFinite(age) ? t("live.lost.mend", { age: age.toFixed(0) }) : t("live.none.mend")}</p>
      </section>
    );
  }
  const { state, cause, remedy, since, goal } = frame.live;
  const key = `state.${state}`;
  const words = key in en ? t(key as TextKey) : state;
  const why = noticeText(t, "cause", cause);
  const tone = toneOf(frame.live);
  return (
    <section class={`card state ${tone}`} aria-live="polite" tabIndex={0} data-state={state} data-cause={cause.code}>
      <h2>{tone !== "" && <Icon name="warning" />} {words}</h2>
      {cause.text !== "" && why !== words && <p class="cause">{why}</p>}
      {remedy.text !== "" && <p class="remedy"><Icon name="next" /> {noticeText(t, "remedy", remedy)}</p>}
      <Silent frame={frame} age={age} />
      <p class="quiet">
        {[goal !== "" && t("state.to", { goal }), since > 0 && t("state.since", { time: timeText(since) })].filter(Boolean).join(" · ")} <Stale age={age} />
      </p>
    </section>
  );
}

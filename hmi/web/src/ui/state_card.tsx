import { api } from "../api";
import { noticeText, useText } from "../i18n";
import { en, type TextKey } from "../i18n/en";
import type { Frame } from "../live/live_socket";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { Icon } from "./icon";
import { Stale, useAge } from "./stale";
import { attempt } from "./toast";

const abnormal = new Set(["fault", "emergency_stop"]);
const standing = new Set(["waiting", "localizing"]);
/** a stay that a person may end */
const stays = new Set(["loading", "unloading", "order-stop"]);

/** The state in large words, why the vehicle stands, since when, and what to do about it. */
export function StateCard({ frame, may }: { frame: Frame | null; may: boolean }) {
  const t = useText();
  const connected = useStore(live.connected);
  const age = useAge(frame);
  if (!frame || !connected) {
    return (
      <section class="card state alarm" aria-live="polite">
        <h2><Icon name="warning" /> {t("live.lost")}</h2>
        <p>{Number.isFinite(age) ? t("live.lost.mend", { age: age.toFixed(0) }) : t("live.none.mend")}</p>
      </section>
    );
  }
  const { state, cause, remedy, since, goal } = frame.live;
  const key = `state.${state}`;
  const staysHere = stays.has(cause.code);
  const tone = abnormal.has(state) ? "alarm" : standing.has(state) && cause.text !== "" && !staysHere ? "caution" : "";
  return (
    <section class={`card state ${tone}`} aria-live="polite" data-state={state}>
      <h2>{tone !== "" && <Icon name="warning" />} {key in en ? t(key as TextKey) : state}</h2>
      <p class="quiet">
        {goal !== "" && <span>{t("state.to", { goal })} </span>}
        {since > 0 && t("state.since", { time: new Date(since * 1000).toLocaleTimeString() })} <Stale age={age} />
      </p>
      {cause.text !== "" && <p class="cause">{noticeText(t, "cause", cause)}</p>}
      {remedy.text !== "" && <p class="remedy"><Icon name="next" /> {noticeText(t, "remedy", remedy)}</p>}
      {may && staysHere && <button type="button" class="target wide" onClick={() => void attempt(() => api.command("go-on"))}>{t("command.go-on")}</button>}
    </section>
  );
}

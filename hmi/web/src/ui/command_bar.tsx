import { useEffect, useState } from "preact/hooks";
import { api } from "../api";
import { useText } from "../i18n";
import { live } from "../live/live_socket";
import { useSelected, useStore } from "../store";
import { Icon, type IconName } from "./icon";
import { asksGoOn, asksResume } from "./state_card";
import { forgetStop, pressStop, unheardStop } from "./stop";
import { attempt } from "./toast";

type CommandName = "start" | "pause" | "resume" | "confirm" | "go-on";

/** A Stop that nobody has heard: what to do instead. */
function Unheard() {
  const t = useText();
  const since = useStore(unheardStop);
  const [now, setNow] = useState(performance.now());
  useEffect(() => {
    if (since === null) return undefined;
    const timer = setInterval(() => setNow(performance.now()), 250);
    return () => clearInterval(timer);
  }, [since]);
  if (since === null) return null;
  return (
    <div class="unheard alarm" role="alert" data-stop="unheard">
      <p><Icon name="warning" /> {t("stop.unheard", { age: Math.max(0, (now - since) / 1000).toFixed(0) })}</p>
      <button type="button" class="target" onClick={forgetStop}>{t("stop.forget")}</button>
    </div>
  );
}

/**
 * Start (or Confirm), Pause, Resume (or Go on) and Stop: the same place on every page, above every card, in every
 * session. Stop is never disabled and needs no PIN; the others are an operator's.
 */
export function CommandBar({ role }: { role: string }) {
  const t = useText();
  const state = useSelected(live.newest, (frame) => frame?.live.state ?? "");
  const goesOn = useSelected(live.newest, (frame) => frame !== null && asksGoOn(frame.live));
  const resumes = useSelected(live.newest, (frame) => frame !== null && asksResume(frame.live));
  const mapping = useSelected(live.newest, (frame) => frame?.live.mapping ?? false);  // there is nothing to start or resume
  const may = role === "operator" || role === "integrator";
  const button = (name: CommandName, icon: IconName, useful: boolean) => (
    <button type="button" class={`target command ${name}`} disabled={!useful || (mapping && name !== "confirm")} onClick={() => void attempt(() => api.command(name))}>
      <Icon name={icon} />
      <span>{t(`command.${name}`)}</span>
    </button>
  );
  const moving = ["driving", "detouring", "waiting", "localizing", "idle"].includes(state);
  const held = state === "emergency_stop" || state === "fault";
  return (
    <footer class="command-bar">
      <Unheard />
      {may && (held ? button("confirm", "good", true) : button("start", "start", state === "paused" || state === "idle"))}
      {may && button("pause", "pause", moving)}
      {may && (goesOn ? button("go-on", "next", true) : button("resume", "resume", resumes || state === "paused" || state === "manual"))}
      {!may && <p class="quiet looks-on">{t(role === "none" ? "command.nobody" : "command.viewer")}</p>}
      <button type="button" class="target command stop" onClick={() => void pressStop(may)}><Icon name="stop" /><span>{t("command.stop")}</span></button>
    </footer>
  );
}

import { api } from "../api";
import { useText } from "../i18n";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { Icon, type IconName } from "./icon";
import { attempt } from "./toast";

type CommandName = "start" | "pause" | "resume" | "stop" | "confirm";

/** Start, Pause, Resume and Stop: the same place on every page, never hidden, never disabled while they may matter. */
export function CommandBar() {
  const t = useText();
  const frame = useStore(live.newest);
  const state = frame?.live.state ?? "idle";
  const button = (name: CommandName, icon: IconName, useful: boolean) => (
    <button class={`target command ${name}`} disabled={!useful} onClick={() => void attempt(() => api.command(name))}>
      <Icon name={icon} />
      <span>{t(`command.${name}`)}</span>
    </button>
  );
  const paused = state === "paused";
  const standing = state === "idle" || paused;
  return (
    <footer class="command-bar">
      {state === "emergency_stop" || state === "fault"
        ? button("confirm", "good", true)
        : button("start", "start", standing && !paused)}
      {button("pause", "pause", !standing)}
      {button("resume", "start", paused)}
      {button("stop", "stop", true)}
    </footer>
  );
}

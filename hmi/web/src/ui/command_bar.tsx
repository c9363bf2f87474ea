import { api } from "../api";
import { useText } from "../i18n";
import { live } from "../live/live_socket";
import { useStore } from "../store";
import { Icon, type IconName } from "./icon";
import { attempt } from "./toast";

type CommandName = "start" | "pause" | "resume" | "stop" | "confirm";

/** Start (or Confirm), Pause, Resume and Stop: the same place on every page, never hidden; Stop is never disabled. */
export function CommandBar({ role }: { role: string }) {
  const t = useText();
  const state = useStore(live.newest)?.live.state ?? "";
  if (role === "viewer") return <footer class="command-bar"><p class="quiet">{t("command.viewer")}</p></footer>;
  const button = (name: CommandName, icon: IconName, useful: boolean) => (
    <button type="button" class={`target command ${name}`} disabled={!useful} onClick={() => void attempt(() => api.command(name))}>
      <Icon name={icon} />
      <span>{t(`command.${name}`)}</span>
    </button>
  );
  const moving = ["driving", "detouring", "waiting", "localizing", "idle"].includes(state);
  const held = state === "emergency_stop" || state === "fault";
  return (
    <footer class="command-bar">
      {held ? button("confirm", "good", true) : button("start", "start", state === "paused" || state === "idle")}
      {button("pause", "pause", moving)}
      {button("resume", "resume", state === "paused" || state === "manual")}
      {button("stop", "stop", true)}
    </footer>
  );
}

import type { RouteNode } from "../../api_types";
import { useText } from "../../i18n";
import type { TextKey } from "../../i18n/en";
import { NumberField } from "../../ui/number_pad";
import { Tool } from "../../ui/tool";
import { freeName, neighbours, remove, setWays, update, waysOf, type RoutePlan, type Ways } from "./route_edit";

export type NodeTool = "move" | "heading" | null;

const words = ["name.station", "name.dock", "name.press", "name.store", "name.charger"] as const;
const actions = ["", "load", "unload", "door", "lift"] as const;
const after: Record<Ways, Ways> = { both: "out", out: "in", in: "both" };

interface Props {
  plan: RoutePlan;
  node: RouteNode;
  tool: NodeTool;
  setTool: (tool: NodeTool) => void;
  change: (plan: RoutePlan) => void;
  close: () => void;
}

/** Everything about one point of the routes; names are offered, so that a panel needs no keyboard. */
export function NodeCard({ plan, node, tool, setTool, change, close }: Props) {
  const t = useText();
  const set = (part: Partial<RouteNode>) => change(update(plan, { ...node, ...part }));
  const label = (id: number) => plan.nodes.find((other) => other.id === id)?.name || String(id);
  const action = (actions as readonly string[]).includes(node.action) ? node.action : "";
  return (
    <section class="node" aria-label={t("routes.point", { id: node.id })}>
      <div class="buttons">
        <Tool icon="station" label={t("routes.station")} pressed={node.station}
          onClick={() => set({ station: !node.station, name: !node.station && node.name === "" ? freeName(plan, t("name.station")) : node.name })} />
        <Tool icon="box" label={t(`action.${action === "" ? "none" : action}` as TextKey)}
          onClick={() => set({ action: actions[(actions.indexOf(action as "") + 1) % actions.length] ?? "" })} />
        <Tool icon="good" label={t("routes.close")} onClick={close} />
      </div>
      <label class="text-field">{t("routes.name")}<input class="target wide" value={node.name} onChange={(event) => set({ name: event.currentTarget.value.trim() })} /></label>
      <div class="buttons" role="group" aria-label={t("routes.names")}>
        {words.map((word) => {
          const name = freeName(plan, t(word));
          return <button key={word} type="button" class="target" onClick={() => set({ name })}>{name}</button>;
        })}
      </div>
      <div class="buttons">
        <NumberField label={t("routes.heading")} value={node.heading_deg} unit="°" least={-360} most={360} optional change={(heading_deg) => set({ heading_deg })} />
        <NumberField label={t("routes.speed")} value={node.speed_mps} unit="m/s" least={0.05} most={3} optional change={(speed_mps) => set({ speed_mps })} />
      </div>
      <div class="buttons">
        <Tool icon="follow" label={t("routes.point_heading")} pressed={tool === "heading"} onClick={() => setTool(tool === "heading" ? null : "heading")} />
        <Tool icon="move" label={t("routes.move")} pressed={tool === "move"} onClick={() => setTool(tool === "move" ? null : "move")} />
        <Tool icon="bin" label={t("routes.delete")} onClick={() => { change(remove(plan, node.id)); close(); }} />
      </div>
      <div class="buttons" role="group" aria-label={t("routes.ways")}>
        {neighbours(plan, node.id).map((other) => {
          const ways = waysOf(plan, node.id, other);
          return <Tool key={other} icon="oneway" label={t(`routes.ways.${ways}`, { from: label(node.id), to: label(other) })} onClick={() => change(setWays(plan, node.id, other, after[ways]))} />;
        })}
      </div>
    </section>
  );
}

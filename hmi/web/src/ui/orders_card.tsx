import { useState } from "preact/hooks";
import { api } from "../api";
import type { RouteNode } from "../api_types";
import { useText } from "../i18n";
import { en, type TextKey } from "../i18n/en";
import { usePolled } from "../store";
import { Icon } from "./icon";
import { attempt } from "./toast";

const repeats = [1, 2, 5, 10, 50];

const nameOf = (nodes: readonly RouteNode[], id: number) => {
  const name = nodes.find((node) => node.id === id)?.name ?? "";
  return name === "" ? String(id) : name;
};

function NewOrder(props: { stations: readonly RouteNode[]; done: () => void }) {
  const t = useText();
  const [chosen, setChosen] = useState<number[]>([]);
  const [repeat, setRepeat] = useState(1);
  const send = async () => {
    if (await attempt(() => api.addOrder({ stations: chosen, repeat }))) props.done();
  };
  return (
    <section class="card">
      <h3>{t("drive.choose")}</h3>
      <p class="chosen">{chosen.map((id) => nameOf(props.stations, id)).join(" → ") || " "}</p>
      <div class="buttons">
        {props.stations.map((node) => (
          <button key={node.id} class="target" onClick={() => setChosen([...chosen, node.id])}>{nameOf(props.stations, node.id)}</button>
        ))}
      </div>
      <div class="buttons">
        <button class="target" onClick={() => setRepeat(repeats[(repeats.indexOf(repeat) + 1) % repeats.length] ?? 1)}>{t("drive.repeat", { count: repeat })}</button>
        <button class="target" onClick={props.done}>{t("drive.back")}</button>
        <button class="target primary" disabled={chosen.length === 0} onClick={() => void send()}>{t("drive.send")}</button>
      </div>
    </section>
  );
}

/** The queue: what is under way, what waits; add, reorder, cancel. */
export function OrdersCard({ nodes }: { nodes: readonly RouteNode[] }) {
  const t = useText();
  const [adding, setAdding] = useState(false);
  const { value: orders, refresh } = usePolled(api.orders, 1000);
  const stations = nodes.some((node) => node.station) ? nodes.filter((node) => node.station) : nodes;
  const finish = () => {
    setAdding(false);
    refresh();
  };
  if (adding) return <NewOrder stations={stations} done={finish} />;
  const open = (orders ?? []).filter((order) => order.status === "queued" || order.status === "running");
  const change = (action: () => Promise<unknown>) => void attempt(action).then(refresh);
  return (
    <section class="card">
      <h3>{t("drive.orders")}</h3>
      {open.length === 0 && <p class="quiet">{t("drive.no_orders")}</p>}
      <ul class="orders">
        {open.map((order) => {
          const status = `order.${order.status}`;
          return (
            <li key={order.id}>
              <span>
                <strong>{order.stations.map((id) => nameOf(nodes, id)).join(" → ")}</strong>
                <small>{status in en ? t(status as TextKey) : order.status}{order.repeat > 1 ? ` · ${t("drive.repeat", { count: order.repeat })}` : ""}</small>
              </span>
              <button class="target" aria-label={t("drive.cancel", { id: order.id })} onClick={() => change(() => api.cancelOrder(order.id))}>
                <Icon name="bin" />
              </button>
            </li>
          );
        })}
      </ul>
      <button class="target primary wide" disabled={stations.length === 0} onClick={() => setAdding(true)}>
        <Icon name="plus" /> {t("drive.new_order")}
      </button>
    </section>
  );
}

import { useEffect, useRef, useState } from "preact/hooks";
import { api } from "../api";
import type { Order, RouteNode } from "../api_types";
import { noticeText, useText, type Translate } from "../i18n";
import { en, type TextKey } from "../i18n/en";
import { usePolled } from "../store";
import { Icon } from "./icon";
import { Stale } from "./stale";
import { attempt } from "./toast";
import { Tool } from "./tool";

const repeats = [1, 2, 5, 10, 50];

export const nameOf = (nodes: readonly RouteNode[], id: number): string => {
  const name = nodes.find((node) => node.id === id)?.name ?? "";
  return name === "" ? String(id) : name;
};

const wayOf = (t: Translate, nodes: readonly RouteNode[], order: Order) => order.stations.map((id, i) => (order.stops[i]?.gone ? t("drive.gone_station", { id }) : nameOf(nodes, id))).join(" → ");

function NewOrder(props: { stations: readonly RouteNode[]; done: () => void }) {
  const t = useText();
  const [chosen, setChosen] = useState<number[]>([]);
  const [repeat, setRepeat] = useState(1);
  const send = async () => {
    if (await attempt(() => api.addOrder({ stations: chosen, repeat }))) props.done();
  };
  return (
    <section class="new-order">
      <h3 class="chosen" aria-live="polite">{chosen.map((id) => nameOf(props.stations, id)).join(" → ") || t("drive.choose")}</h3>
      <div class="buttons stations">
        {props.stations.map((node) => (
          <button key={node.id} type="button" class="target" onClick={() => setChosen([...chosen, node.id])}>{nameOf(props.stations, node.id)}</button>
        ))}
      </div>
      <div class="buttons send">
        <Tool icon="back" label={t("drive.back")} onClick={() => (chosen.length > 0 ? setChosen(chosen.slice(0, -1)) : props.done())} />
        <Tool icon="repeat" label={t("drive.repeat", { count: repeat })} onClick={() => setRepeat(repeats[(repeats.indexOf(repeat) + 1) % repeats.length] ?? 1)} />
        <Tool icon="next" label={t("drive.send")} primary disabled={chosen.length === 0} onClick={() => void send()} />
      </div>
    </section>
  );
}

/** What can be done with the chosen order. */
function OrderTools(props: { order: Order; queue: readonly number[]; change: (action: () => Promise<unknown>) => void }) {
  const t = useText();
  const { order, queue, change } = props;
  const at = queue.indexOf(order.id);
  const tools = useRef<HTMLDivElement>(null);
  useEffect(() => tools.current?.scrollIntoView({ block: "nearest" }), []);  // once: the list stays where a finger moves it
  const move = (by: number) => {
    const ids = queue.filter((id) => id !== order.id);
    ids.splice(at + by, 0, order.id);
    change(() => api.reorder({ ids }));
  };
  return (
    <div class="buttons" role="group" aria-label={t("drive.order", { id: order.id })} ref={tools}>
      <Tool icon="up" label={t("drive.earlier")} disabled={at <= 0} onClick={() => move(-1)} />
      <Tool icon="down" label={t("drive.later")} disabled={at < 0 || at === queue.length - 1} onClick={() => move(1)} />
      <Tool icon="bin" label={t("drive.cancel")} onClick={() => change(() => api.cancelOrder(order.id))} />
    </div>
  );
}

function OrderRow(props: { order: Order; nodes: readonly RouteNode[]; chosen: boolean; choose: () => void }) {
  const t = useText();
  const { order } = props;
  const status = `order.${order.status}`;
  return (
    <button type="button" class="target row" aria-pressed={props.chosen} onClick={props.choose}>
      <Icon name={order.status === "running" ? "drive" : order.status === "done" ? "good" : order.status === "queued" ? "list" : "bad"} />
      <span>
        <strong>{wayOf(t, props.nodes, order)}</strong>
        <small>
          {status in en ? t(status as TextKey) : order.status}
          {order.repeat > 1 && ` · ${t("drive.round", { round: (order.round ?? 0) + 1, count: order.repeat })}`}
          {order.detail.text !== "" && ` · ${noticeText(t, "order", order.detail)}`}
        </small>
      </span>
    </button>
  );
}

function Finished({ nodes, again }: { nodes: readonly RouteNode[]; again: () => void }) {
  const t = useText();
  const { value } = usePolled(api.ordersHistory, 2000);
  const [chosen, setChosen] = useState<number | null>(null);
  return (
    <>
      {value && value.length > 0 && <h3>{t("drive.finished")}</h3>}
      {(value ?? []).slice(0, 10).map((order) => (
        <div key={order.id}>
          <OrderRow order={order} nodes={nodes} chosen={order.id === chosen} choose={() => setChosen(order.id === chosen ? null : order.id)} />
          {order.id === chosen && <div class="buttons"><Tool icon="repeat" label={t("drive.again")} onClick={() => void attempt(() => api.repeatOrder(order.id)).then(again)} /></div>}
        </div>
      ))}
    </>
  );
}

/** The queue: what is under way, what waits; add, reorder, cancel, once more. */
export function OrdersCard({ nodes, may }: { nodes: readonly RouteNode[]; may: boolean }) {
  const t = useText();
  const [adding, setAdding] = useState(false);
  const [chosen, setChosen] = useState<number | null>(null);
  const { value: orders, refresh, age_s } = usePolled(api.orders, 1000);
  const stations = nodes.some((node) => node.station) ? nodes.filter((node) => node.station) : nodes;
  const finish = () => {
    setAdding(false);
    refresh();
  };
  if (adding) return <NewOrder stations={stations} done={finish} />;
  const open = (orders ?? []).filter((order) => order.status === "queued" || order.status === "running");
  const queue = open.filter((order) => order.status === "queued").map((order) => order.id);
  const change = (action: () => Promise<unknown>) => void attempt(action).then(refresh);
  return (
    <section class="orders">
      {may && <button type="button" class="target primary wide" disabled={stations.length === 0} onClick={() => setAdding(true)}><Icon name="plus" /> {t("drive.new_order")}</button>}
      <Stale age={age_s} limit={4} />
      {open.length === 0 && <p class="quiet">{stations.length === 0 ? t("drive.no_stations") : t("drive.no_orders")}</p>}
      {open.map((order) => (
        <div key={order.id}>
          <OrderRow order={order} nodes={nodes} chosen={order.id === chosen} choose={() => setChosen(order.id === chosen ? null : order.id)} />
          {may && order.id === chosen && <OrderTools order={order} queue={queue} change={change} />}
        </div>
      ))}
      <Finished nodes={nodes} again={refresh} />
    </section>
  );
}

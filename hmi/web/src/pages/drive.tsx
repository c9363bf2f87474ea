import { useEffect, useRef, useState } from "preact/hooks";
import type { Routes, Site, Walls } from "../api_types";
import { useText } from "../i18n";
import { live, type Frame } from "../live/live_socket";
import type { FactoryMap } from "../map/factory_map";
import { MapView } from "../map/map_view";
import { api } from "../api";
import { useStore } from "../store";
import { HoldButton } from "../ui/hold_button";
import { Icon } from "../ui/icon";
import { OrdersCard } from "../ui/orders_card";
import { Gauges, StateCard } from "../ui/state_card";

const JOG_MPS = 0.3;
const JOG_RADPS = 0.4;

function Jog() {
  const t = useText();
  const [open, setOpen] = useState(false);
  const hold = (linear: number, angular: number) => ({
    held: () => live.jog(linear, angular),
    released: () => live.jog(0, 0),
  });
  return (
    <section class="card">
      <button class="target wide" aria-expanded={open} onClick={() => setOpen(!open)}>{t("drive.jog")}</button>
      {open && (
        <>
          <p class="quiet">{t("drive.jog.hint")}</p>
          <div class="jog">
            <HoldButton icon="left" label={t("drive.left")} {...hold(0, JOG_RADPS)} />
            <HoldButton icon="up" label={t("drive.forward")} {...hold(JOG_MPS, 0)} />
            <HoldButton icon="right" label={t("drive.right")} {...hold(0, -JOG_RADPS)} />
            <HoldButton icon="down" label={t("drive.backward")} {...hold(-JOG_MPS, 0)} />
          </div>
        </>
      )}
    </section>
  );
}

function Replay(props: { onFrame: (frame: Frame | null) => void }) {
  const t = useText();
  const [back, setBack] = useState(0);
  const choose = (seconds: number) => {
    setBack(seconds);
    const wanted = performance.now() - seconds * 1000;
    props.onFrame(seconds === 0 ? null : (live.history.findLast((frame) => frame.received_ms <= wanted) ?? live.history[0] ?? null));
  };
  return (
    <section class="card">
      <label>
        {t("drive.replay")}: {back === 0 ? t("drive.replay.now") : t("drive.replay.at", { age: back.toFixed(0) })}
        <input class="target wide" type="range" min={0} max={30} step={0.5} value={30 - back}
          onInput={(event) => choose(30 - Number(event.currentTarget.value))} />
      </label>
    </section>
  );
}

/** The operator's page: where the vehicle is, what it does, why it stands, and what to send it next. */
export function DrivePage({ site, walls, routes }: { site: Site; walls: Walls; routes: Routes }) {
  const t = useText();
  const map = useRef<FactoryMap | null>(null);
  const [following, setFollowing] = useState(false);
  const replayed = useRef<Frame | null>(null);
  const frame = useStore(live.newest);
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.showSite(site, api.drawingUrl(site.walls_revision));
    made.showWalls(walls.walls);
    made.showRoutes(routes);
    const show = (next: Frame | null) => {
      const shown = replayed.current ?? next;
      if (shown) made.showLive(shown.live, shown.scan, site.vehicle);
    };
    show(live.newest.value);
    return live.newest.watch(show);
  };
  useEffect(() => {
    if (map.current) map.current.following = following;
  }, [following]);
  return (
    <main class="page with-map">
      <MapView ready={ready}>
        <button class="target" aria-label={t("drive.follow")} aria-pressed={following} onClick={() => setFollowing(!following)}>
          <Icon name="follow" />
        </button>
      </MapView>
      <aside>
        <StateCard frame={frame} />
        <OrdersCard nodes={routes.nodes} />
        <Gauges frame={frame} />
        <Jog />
        <Replay onFrame={(chosen) => (replayed.current = chosen)} />
      </aside>
    </main>
  );
}

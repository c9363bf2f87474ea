import type { ComponentChildren } from "preact";
import { useText } from "../i18n";
import { Icon } from "../ui/icon";
import { FactoryMap } from "./factory_map";
import { useMap } from "./use_map";

/** A FactoryMap in the page, with zoom buttons. `ready` runs once; what it returns runs at the end. */
export function MapView(props: { ready: (map: FactoryMap) => void | (() => void); children?: ComponentChildren; above?: ComponentChildren }) {
  const t = useText();
  const { target, map } = useMap((element) => new FactoryMap(element), props.ready);
  return (
    <div class="map">
      <div ref={target} class="map-canvas" role="application" aria-label={t("map.label")} tabIndex={0} />
      {props.above}
      <div class="map-tools">
        <button class="target" aria-label={t("map.zoom_in")} onClick={() => map.current?.zoom(1)}><Icon name="plus" /></button>
        <button class="target" aria-label={t("map.zoom_out")} onClick={() => map.current?.zoom(-1)}><Icon name="minus" /></button>
        <button class="target" aria-label={t("map.fit")} onClick={() => map.current?.fitWalls()}><Icon name="fit" /></button>
        {props.children}
      </div>
    </div>
  );
}

import type { ComponentChildren } from "preact";
import type { TileInfo } from "../api_types";
import { loadDraft } from "../drafts";
import { useText } from "../i18n";
import { Icon } from "../ui/icon";
import { PhotoMap, type PhotoPlace } from "./photo_map";
import { useMap } from "./use_map";

/** A PhotoMap in the page, with zoom buttons and the attribution that every showing needs. */
export function PhotoView(props: { info: TileInfo; site: string; ready: (map: PhotoMap) => void | (() => void); children?: ComponentChildren }) {
  const t = useText();
  const near = () => loadDraft<PhotoPlace>(props.site, "photographs")?.value ?? null;
  const { target, map } = useMap((element) => new PhotoMap(element, props.info, near()), props.ready);
  return (
    <div class="map photo">
      <div ref={target} class="map-canvas" role="application" aria-label={t("scale.photo")} tabIndex={0} />
      <div class="map-tools">
        <button type="button" class="target" aria-label={t("map.zoom_in")} onClick={() => map.current?.zoom(1)}><Icon name="plus" /></button>
        <button type="button" class="target" aria-label={t("map.zoom_out")} onClick={() => map.current?.zoom(-1)}><Icon name="minus" /></button>
        {props.children}
      </div>
      <p class="attribution">{props.info.attribution}</p>
    </div>
  );
}

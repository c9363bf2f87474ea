import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { api } from "../../api";
import type { DayChange, DoubtedWall, KeptDay, Site, Walls } from "../../api_types";
import { useText } from "../../i18n";
import { extentOfChange, extentOfWall, showChanges } from "../../map/change_layer";
import { DayLayer, dayColours } from "../../map/day_layer";
import type { FactoryMap } from "../../map/factory_map";
import { MapView } from "../../map/map_view";
import { attempt } from "../../ui/toast";
import { keyOf, type Chosen } from "./chosen";

function Legend() {
  const t = useText();
  return (
    <ul class="legend" aria-label={t("changes.legend")}>
      {(Object.keys(dayColours) as (keyof typeof dayColours)[]).map((state) => <li key={state}><i class={`day-${dayColours[state]}`} />{t(`day.${state}`)}</li>)}
    </ul>
  );
}

/** The map of a day, with what changed and the walls in doubt marked on it; it follows the row that was touched. */
export function ChangesMap(props: { site: Site; walls: Walls; day: KeptDay | null; changes: readonly DayChange[]; doubts: readonly DoubtedWall[]; chosen: Chosen; children: ComponentChildren }) {
  const { site, walls, day, changes, doubts, chosen } = props;
  const map = useRef<FactoryMap | null>(null);
  const layer = useRef<DayLayer | null>(null);
  const ready = (made: FactoryMap) => {
    map.current = made;
    made.room = [20, 20, 130, 20];  // the slider
    made.showSite(site, site.drawing ? api.drawingUrl(site.walls_revision) : null);
    made.showWalls(walls.walls);
    made.fitWalls();
    const days = new DayLayer(made);
    layer.current = days;
    return () => days.dispose();
  };
  const one = [...changes, ...doubts].find((each) => keyOf(each) === chosen.key) ?? null;
  useEffect(() => void attempt(async () => layer.current?.show(day)), [day?.date, day?.extent.join()]);
  useEffect(() => map.current?.showWalls(walls.walls), [walls.revision]);
  useEffect(() => {
    if (map.current) showChanges(map.current.sketch, changes, doubts, one);
  }, [JSON.stringify([changes, doubts]), chosen.key]);
  useEffect(() => {
    if (one) map.current?.showPlace("segments" in one ? extentOfWall(one) : extentOfChange(one));
  }, [chosen.touched]);
  return <MapView ready={ready} above={day && <Legend />}>{props.children}</MapView>;
}

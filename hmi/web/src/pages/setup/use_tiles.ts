import { useEffect, useState } from "preact/hooks";
import { api } from "../../api";
import type { TileInfo } from "../../api_types";

/** The saved photographs; null while they are asked for or where there are none. */
export function useTiles(): { info: TileInfo | null; key: string; load: () => void } {
  const [info, setInfo] = useState<TileInfo | null>(null);
  const load = () => void api.tiles().then((tiles) => setInfo(tiles.tiles.length > 0 ? tiles : null), () => undefined);
  useEffect(load, []);
  return { info, key: info ? `${info.source} ${info.zoom} ${info.tiles.length}` : "", load };
}

import { Refused } from "./api";
import type { Routes, Site, Walls } from "./api_types";

/** What the pages show of a site. */
export interface Content {
  site: Site;
  walls: Walls;
  routes: Routes;
}
interface Source {
  site: () => Promise<Site>;
  walls: () => Promise<Walls>;
  routes: () => Promise<Routes>;
}
const kTurns = 8;

/** Site, walls and routes of one moment: three answers between which somebody saved do not belong together, and are asked for again. */
export async function loadContent(from: Source): Promise<Content> {
  for (let turn = 0; turn < kTurns; ++turn) {
    const [site, walls, routes] = await Promise.all([from.site(), from.walls(), from.routes()]);
    if (site.walls_revision === walls.revision && site.routes_revision === routes.revision) return { site, walls, routes };
  }
  throw new Refused(409, "conflict", "the site is being changed all the time: load the page again");
}

/** Of loads that overlap only the one asked for last is shown; who asked for an earlier one waits for it too. */
export function newestOnly<T>(ask: () => Promise<T>, show: (value: T) => void): () => Promise<void> {
  let newest: Promise<void> | null = null;
  return () => {
    const mine: Promise<void> = ask().then((value) => (mine === newest ? show(value) : (newest ?? undefined)));
    newest = mine;
    return mine;
  };
}

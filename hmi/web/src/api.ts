import type * as wire from "./api_types";

/** A refusal of the server: `code` for the catalogues, the message for a person. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    text: string,
    readonly values: Record<string, string> = {},
  ) {
    super(text);
  }
}

/** Told whenever the server wants a PIN: the session is over, or the server was started anew. */
export const pinWanted = { tell: (): void => undefined };

async function request<T>(method: string, path: string, body?: unknown, raw?: Blob, answer_ms?: number): Promise<T> {
  let response: Response;
  try {
    response = await fetch(path, {
      method,
      credentials: "same-origin",
      headers: raw || body === undefined ? {} : { "Content-Type": "application/json" },
      ...(answer_ms === undefined ? {} : { signal: AbortSignal.timeout(answer_ms) }),
      body: raw ?? (body === undefined ? undefined : JSON.stringify(body)),
    });
  } catch {
    throw new Refused(0, "no-connection", "the vehicle does not answer");
  }
  const text = await response.text();
  const parsed: unknown = text === "" ? {} : JSON.parse(text);
  if (!response.ok) {
    const { error } = parsed as wire.ApiError;
    if (error.code === "no-session") pinWanted.tell();
    throw new Refused(response.status, error.code, error.text, error.values ?? {});
  }
  return parsed as T;
}

const get = <T>(path: string) => request<T>("GET", path);
const post = <T = unknown>(path: string, body: unknown = {}) => request<T>("POST", path, body);
const put = <T>(path: string, body: unknown) => request<T>("PUT", path, body);

export const api = {
  session: () => get<wire.Session>("/api/session"),
  login: (pin: string) => post<wire.Session>("/api/session", { pin }),
  logout: () => request("DELETE", "/api/session"),

  site: () => get<wire.Site>("/api/site"),
  setup: () => get<wire.Setup>("/api/setup"),
  drawingUrl: (revision: string) => `/api/site/drawing.png?r=${encodeURIComponent(revision)}`,
  walls: () => get<wire.Walls>("/api/site/walls"),
  wallsSeen: () => get<wire.WallPiece[]>("/api/site/walls/seen"),
  doubtedWalls: () => get<wire.DoubtedWall[]>("/api/site/walls/doubted"),
  wallStands: (wall: wire.StandingWall) => post("/api/site/walls/standing", wall),
  saveWalls: (edit: wire.WallsEdit) => put<wire.Saved>("/api/site/walls", edit),
  uploadDrawing: (file: File, options: Record<string, string>) =>
    request<wire.Job>("POST", `/api/site/drawing?${new URLSearchParams({ name: file.name, ...options }).toString()}`, undefined, file),
  previewDrawing: (file: File) => request<wire.Job>("POST", `/api/site/drawing/preview?${new URLSearchParams({ name: file.name }).toString()}`, undefined, file),
  preview: () => get<wire.RevisionPreview>("/api/site/drawing/preview"),
  movePreview: (by: wire.PreviewMove) => post<wire.RevisionPreview>("/api/site/drawing/preview/move", by),
  applyPreview: () => post("/api/site/drawing/preview/apply"),
  dropPreview: () => request("DELETE", "/api/site/drawing/preview"),
  restoreBackup: (file: File) => request<wire.Restored>("POST", "/api/site/backup", undefined, file),
  job: () => get<wire.Job>("/api/job"),
  cancelJob: () => request("DELETE", "/api/job"),
  scale: (measurements: wire.ScaleRequest) => post<wire.ScaleResult>("/api/site/scale", measurements),
  tiles: () => get<wire.TileInfo>("/api/site/tiles"),
  tileSources: () => get<wire.TileSourceInfo[]>("/api/site/tiles/sources"),
  fetchTiles: (wanted: wire.TileRequest) => post<wire.Job>("/api/site/tiles", wanted),

  mapping: () => get<wire.Mapping>("/api/mapping"),
  mappingPoints: async () => {
    const answer = await fetch("/api/mapping/points", { credentials: "same-origin" });
    if (!answer.ok) throw new Refused(answer.status, "not-mapping", "no map is being made");
    return answer.arrayBuffer();
  },
  startMapping: (start: wire.MappingStart) => post("/api/mapping", start),
  dropMapping: () => request("DELETE", "/api/mapping"),
  finishMapping: () => post<wire.Job>("/api/mapping/finish"),

  routes: () => get<wire.Routes>("/api/site/routes"),
  drivenWay: () => get<wire.DrivenWay>("/api/site/routes/driven"),
  teachRoutes: (edit: wire.RoutesEdit) => post<wire.Routes>("/api/site/routes/taught", edit),
  checkRoutes: (edit: wire.RoutesEdit) => post<wire.Routes>("/api/site/routes/check", edit),
  saveRoutes: (edit: wire.RoutesEdit) => put<wire.Routes>("/api/site/routes", edit),
  importRoutes: (csv: wire.RoutesCsv) => post<wire.Routes>("/api/site/routes/csv", csv),

  versions: () => get<wire.SiteVersion[]>("/api/site/versions"),
  compareVersions: (before: number, after: number) => get<wire.VersionDiff>(`/api/site/versions/${before}/against/${after}`),
  restoreVersion: (number: number) => post(`/api/site/versions/${number}/restore`),

  days: () => get<wire.KeptDays>("/api/site/days"),
  dayUrl: (date: string) => `/api/site/days/${date}/map.png`,
  dayChanges: (a: string, b: string) => get<wire.DayChanges>(`/api/site/days/${a}/against/${b}`),

  devices: () => get<wire.FoundDevice[]>("/api/devices"),
  searchDevices: () => post<wire.FoundDevice[]>("/api/devices/search"),
  lidarViews: () => get<wire.LidarView[]>("/api/devices/views"),
  mounting: () => get<wire.MountingState>("/api/mounting"),
  measureMounting: () => post("/api/mounting"),
  stopMeasuring: () => request("DELETE", "/api/mounting"),
  saveVehicle: (edit: wire.VehicleEdit) => put<wire.Saved>("/api/site/vehicle", edit),
  braking: () => get<wire.Braking>("/api/vehicle/braking"),
  startBraking: (how: wire.BrakingStart) => post("/api/vehicle/braking", how),
  locate: () => get<wire.Locate>("/api/locate"),
  searchAnew: () => post("/api/locate/search"),
  setPose: (pose: wire.SetPose) => post("/api/vehicle/pose", pose),

  command: (name: "start" | "pause" | "resume" | "confirm" | "go-on") => post(`/api/vehicle/${name}`),
  stop: (answer_ms: number) => request("POST", "/api/vehicle/stop", {}, undefined, answer_ms),
  /** needs no PIN */
  halt: (answer_ms: number) => request("POST", "/api/vehicle/halt", {}, undefined, answer_ms),
  report: (what: wire.PlaceReport) => post("/api/vehicle/report", what),
  replay: async () => {
    const answer = await fetch("/api/replay", { credentials: "same-origin" });
    if (!answer.ok) throw new Refused(answer.status, "not-found", "there is no replay");
    return answer.arrayBuffer();
  },

  orders: () => get<wire.Order[]>("/api/orders"),
  ordersHistory: () => get<wire.Order[]>("/api/orders/history"),
  addOrder: (order: wire.NewOrder) => post("/api/orders", order),
  reorder: (queue: wire.OrderQueue) => put("/api/orders/queue", queue),
  repeatOrder: (id: number) => post(`/api/orders/${id}/repeat`),
  cancelOrder: (id: number) => request("DELETE", `/api/orders/${id}`),

  events: () => get<wire.Event[]>("/api/events"),
  statistics: () => get<wire.Statistics>("/api/statistics"),
  recordings: () => get<wire.Recording[]>("/api/recordings"),
};

import type * as wire from "./api_types";

/** A refusal of the server: `code` for the catalogues, the message for a person. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    readonly code: string,
    text: string,
  ) {
    super(text);
  }
}

async function request<T>(method: string, path: string, body?: unknown, raw?: Blob): Promise<T> {
  let response: Response;
  try {
    response = await fetch(path, {
      method,
      credentials: "same-origin",
      headers: raw || body === undefined ? {} : { "Content-Type": "application/json" },
      body: raw ?? (body === undefined ? undefined : JSON.stringify(body)),
    });
  } catch {
    throw new Refused(0, "no-connection", "the vehicle does not answer");
  }
  const text = await response.text();
  const parsed: unknown = text === "" ? {} : JSON.parse(text);
  if (!response.ok) {
    const { error } = parsed as wire.ApiError;
    throw new Refused(response.status, error.code, error.text);
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
  drawingUrl: (revision: string) => `/api/site/drawing.png?r=${encodeURIComponent(revision)}`,
  walls: () => get<wire.Walls>("/api/site/walls"),
  saveWalls: (edit: wire.WallsEdit) => put<wire.Saved>("/api/site/walls", edit),
  uploadDrawing: (file: File) =>
    request<wire.Job>("POST", `/api/site/drawing?name=${encodeURIComponent(file.name)}`, undefined, file),
  job: () => get<wire.Job>("/api/job"),
  scale: (measurements: wire.ScaleRequest) => post<wire.ScaleResult>("/api/site/scale", measurements),
  tiles: () => get<wire.TileInfo>("/api/site/tiles"),
  fetchTiles: (wanted: wire.TileRequest) => post<wire.Job>("/api/site/tiles", wanted),

  routes: () => get<wire.Routes>("/api/site/routes"),
  checkRoutes: (edit: wire.RoutesEdit) => post<wire.Routes>("/api/site/routes/check", edit),
  saveRoutes: (edit: wire.RoutesEdit) => put<wire.Routes>("/api/site/routes", edit),
  importRoutes: (csv: wire.RoutesCsv) => post<wire.Routes>("/api/site/routes/csv", csv),
  routesCsv: () => get<wire.RoutesCsv>("/api/site/routes/csv"),

  command: (name: "start" | "pause" | "resume" | "stop" | "confirm") => post(`/api/vehicle/${name}`),

  orders: () => get<wire.Order[]>("/api/orders"),
  addOrder: (order: wire.NewOrder) => post("/api/orders", order),
  cancelOrder: (id: number) => request("DELETE", `/api/orders/${id}`),

  events: () => get<wire.Event[]>("/api/events"),
  statistics: () => get<wire.Statistics>("/api/statistics"),
  recordings: () => get<wire.Recording[]>("/api/recordings"),
};

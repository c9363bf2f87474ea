// What is amber on the map after a drive (number 18 of docs/explanation/operator-page.md), before the real server and the
// virtual factory, on a drawing that was imported from a scan: a room that was torn down is amber, the walls that stand are not.
// Usage: amber_walls.mjs MADORI PAGE DATA SHOTS WIDTHxHEIGHT [as-drawn]      as-drawn: everything stands
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { askServer as api, expect, touch, until } from "./browser.mjs";
import { distance, lengthOf, nearShare, trueFaces } from "./pieces.mjs";
import { freeUdpPort, startFactory, startVehicle, temporaryFolder } from "./processes.mjs";
import { given, openGivenPanel, picture, run } from "./program.mjs";

const { madori, page, data } = given;
const kNear_m = 10;  // of the way: what an operator sees around the vehicle
const kMostStanding = 0.03;  // of the standing walls: 0.006 to 0.020 were measured; 0.047 to 0.055 where beams beside a column count
const kTornDown = [37, 50];  // the faces of the room at the way to Press 1, from and to

/** The demo's scenario with some walls not built. */
function scenario(folder, missing) {
  const text = readFileSync(join(data, "scenarios/demo.yaml"), "utf8").replace("../sample_factory", join(data, "sample_factory"));
  const built = text.replace(/^building: \{(.*)\}$/m, `building: {$1, missing_walls: [${missing.join(", ")}]}`);
  expect(missing.length === 0 || built !== text, "the demo's scenario has another building line");
  const file = join(folder, "scenario.yaml");
  writeFileSync(file, missing.length > 0 ? built : text);
  return file;
}

/** Keeps in the page where the vehicle was while it knew its place. */
const keepWay = (panel) => panel.page.evaluate(() => {
  window.way = [];
  const socket = new WebSocket(`ws://${location.host}/api/live`);
  socket.onmessage = ({ data: text }) => {
    const pose = typeof text === "string" ? JSON.parse(text).live?.pose : null;
    const [x, y] = window.way.at(-1) ?? [Infinity, 0];
    if (pose && pose.health !== "LOST" && Math.hypot(pose.x - x, pose.y - y) > 1) window.way.push([pose.x, pose.y]);
  };
});

/** To Press 1 and to the lift; faults of a busy machine are confirmed. */
async function deliver(panel) {
  const { nodes } = (await api(panel, "GET", "/api/site/routes")).json;
  const stations = ["Press 1", "Lift"].map((name) => nodes.find((node) => node.name === name).id);
  let order;
  await until("the site is loaded", async () => {  // a busy machine may still read it
    order = await api(panel, "POST", "/api/orders", { stations, repeat: 1 });
    return order.json.error?.code !== "not-drivable";
  });
  expect(order.status === 200, `the order was refused: ${JSON.stringify(order)}`);
  await until("the order is delivered", async () => {
    const button = { fault: "confirm", paused: "resume" }[await panel.page.locator("[data-state]").getAttribute("data-state")];
    if (button) await panel.page.locator(`.command.${button}`).tap({ timeout: 1000 }).catch(() => undefined);
    return (await api(panel, "GET", "/api/orders/history")).json.some((one) => one.status === "done");
  }, 400_000);
}

/** The pieces of wall that are painted as seen near the way, and which of them in the legend's amber. */
const painted = (panel) => panel.page.evaluate(([near_m]) => {
  const colour = document.createElement("canvas").getContext("2d");
  const same = (css) => { colour.fillStyle = css; return colour.fillStyle; };
  const amber = ["missing", "displaced"].map((state) => same(getComputedStyle(document.querySelector(`.legend .wall-${state}`)).borderTopColor));
  const pieces = [];
  for (const layer of document.querySelector(".map-canvas").olMap.getLayers().getArray())
    for (const feature of layer.getSource()?.getFeatures?.() ?? []) {
      if (feature.get("state") === undefined) continue;
      const line = feature.getGeometry();
      if (!window.way.some(([x, y]) => { const [a, b] = line.getClosestPoint([x, y]); return Math.hypot(a - x, b - y) < near_m; })) continue;
      const styles = [layer.getStyleFunction()(feature, 0.1)].flat();
      pieces.push({ segment: line.getCoordinates().flat(), state: feature.get("state"), amber: styles.some((style) => amber.includes(same(style.getStroke().getColor()))) });
    }
  return pieces;
}, [kNear_m]);

const metres = (pieces) => pieces.reduce((sum, { segment }) => sum + lengthOf(segment), 0);

/** One drive: the pieces near the way that lie on walls that stand, and on those that were torn down. */
async function drive(browser, missing) {
  const folder = temporaryFolder();
  const lidar = await freeUdpPort();
  const device = await startFactory(madori, data, join(folder, "site"), lidar, scenario(folder, missing));
  const panel = await openGivenPanel(browser, await startVehicle(madori, page, join(folder, "site"), lidar, device, ["--no-record"]));
  await touch(panel, "Drive", { exact: true });
  await keepWay(panel);
  await deliver(panel);
  await panel.page.waitForTimeout(6000);  // the page asks every 5 s
  await picture(panel, "amber-walls");
  const pieces = await painted(panel);
  const faces = trueFaces(data);
  const gone = missing.map((id) => faces.get(id));
  for (const id of missing) faces.delete(id);
  const on = (others) => pieces.filter(({ segment }) => nearShare(segment, others) >= 0.8);
  return { standing: on([...faces.values()]), tornDown: missing.length > 0 ? on(gone) : [] };
}

async function main(browser) {
  const missing = process.argv[7] === "as-drawn" ? [] : Array.from({ length: kTornDown[1] - kTornDown[0] + 1 }, (_, i) => kTornDown[0] + i);
  const { standing, tornDown } = await drive(browser, missing);
  const amber = (pieces) => metres(pieces.filter((piece) => piece.amber));
  console.log(`of ${metres(standing).toFixed(1)} m that stand ${amber(standing).toFixed(1)} m are amber, of ${metres(tornDown).toFixed(1)} m torn down ${amber(tornDown).toFixed(1)} m`);
  expect(metres(standing) > 50, `18: only ${metres(standing).toFixed(1)} m of standing walls were seen`);
  expect(amber(standing) < kMostStanding * metres(standing), `18: ${amber(standing).toFixed(1)} of ${metres(standing).toFixed(1)} m that stand are amber`);
  if (missing.length === 0) return;
  expect(metres(tornDown) > 10, `18: only ${metres(tornDown).toFixed(1)} m of the room that is gone were looked through`);
  expect(amber(tornDown) > 0.8 * metres(tornDown), `18: of ${metres(tornDown).toFixed(1)} m torn down only ${amber(tornDown).toFixed(1)} m are amber`);
}

await run(main);

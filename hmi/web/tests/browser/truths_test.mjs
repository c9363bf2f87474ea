// What the page itself does wrong or right, before a made-up vehicle (numbers of docs/explanation/operator-page.md):
// 3 and 8 old and unknown data, 11 to 13 and 15 places of buttons, 17 and 19 words, 20 a phone held upright, focus order;
// scrolled: lists stay where a finger moves them; login: all of it on the smallest panel;
// place: how probable it is.
// Usage: truths_test.mjs PAGE [FOLDER_FOR_PICTURES]
import { existsSync, mkdirSync } from "node:fs";
import { join } from "node:path";
import { expect, openBrowser, openPanel, skipUnlessInstalled, touch } from "../../../../tests/end_to_end/panel/browser.mjs";
import { startMadeUpVehicle } from "./made_up_vehicle.mjs";

const [page, shots] = process.argv.slice(2);
skipUnlessInstalled();
if (!existsSync(join(page, "index.html"))) {
  console.log(`skipped: ${page} holds no built page (cmake --build build/release --target panel)`);
  process.exit(77);
}
if (shots) mkdirSync(shots, { recursive: true });

const vehicle = await startMadeUpVehicle(page, { points: 2000 });
const browser = await openBrowser();
const look = (panel, name) => shots && panel.page.screenshot({ path: join(shots, `${name}.png`) });
const within = async (panel, selector, { least_px = 0 } = {}) => {
  const box = await panel.page.locator(selector).first().boundingBox();
  expect(box, `${selector} is not there`);
  const { width, height } = panel.page.viewportSize();
  expect(box.x >= -1 && box.y >= -1 && box.x + box.width <= width + 1 && box.y + box.height <= height + 1, `${selector} sticks out: ${JSON.stringify(box)}`);
  expect(Math.min(box.width, box.height) >= least_px, `${selector} is ${box.width} x ${box.height} px`);
  const covered = await panel.page.locator(selector).first().evaluate((element, [x, y]) => !element.contains(document.elementFromPoint(x, y)), [box.x + box.width / 2, box.y + box.height / 2]);
  expect(!covered, `${selector} is covered`);
  return box;
};

const wanted = process.env["TRUTHS"]?.split(";");  // for whoever mends one of them

async function small(number, size, check) {
  if (wanted && !wanted.includes(number)) return [];
  const panel = await openPanel(browser, vehicle.address, size);
  try {
    await panel.page.locator("[data-state]").waitFor();
    await check(panel);
    console.log(`${number}: good`);
    return [];
  } catch (error) {
    console.log(`${number}: FAILED ${error.message}`);
    return [`${number}: ${error.message}`];
  } finally {
    vehicle.say({});
    vehicle.hold(false);
    for (const [path, json] of Object.entries(kUsual)) vehicle.answer(path, json);
    await panel.context.close();
  }
}

/** A standstill with a cause, a remedy and a goal: what made the state card grow, and all below it leave the screen. */
async function standWithReason(panel) {
  vehicle.say({ state: "waiting", goal: "Press 1", cause: { code: "held-back", values: {}, text: "x" }, remedy: { code: "look-and-resume", values: {}, text: "x" } });
  await panel.page.locator(".state .cause").waitFor();
}

const kUsual = { "/api/session": { role: "integrator", needs_pin: false } };
const kSmall = { width: 1024, height: 600 };
const kPhone = { width: 390, height: 844 };
const failed = [
  ...(await small("3", kSmall, async (panel) => {
    vehicle.say({ devices: [{ name: "lidar", type: "made_up", title: "Made-up", healthy: false, age_s: 12, rate_hz: 0, detail: { code: "", values: {}, text: "" } }, { name: "drive", type: "drive", title: "", healthy: false, age_s: 12, rate_hz: 0, detail: { code: "", values: {}, text: "" } }] });
    await panel.page.locator("[data-silent=made_up]").waitFor({ timeout: 3000 });
    await panel.page.locator(".map-canvas[data-scan=hidden]").waitFor({ timeout: 3000 });
    for (const name of ["Score", "Speed", "Battery"]) expect((await panel.page.locator(".gauge", { hasText: name }).locator("dd").innerText()).includes("12 s old"), `${name} is shown as if it were now`);
  })),
  ...(await small("8", kSmall, async (panel) => {
    vehicle.say({ pose: { x: 0, y: 0, yaw: 0, covariance: [1e4, 0, 1e4, 9], health: "LOST", health_reason: "", age_s: 0 } });
    await panel.page.locator(".map-canvas[data-vehicle=hidden][data-scan=hidden]").waitFor({ timeout: 3000 });
    await panel.page.locator("[data-banner=lost]").waitFor({ timeout: 3000 });
  })),
  ...(await small("place", kSmall, async (panel) => {
    vehicle.say({ pose: { x: 20, y: 20, yaw: 0, covariance: [0.01, 0, 0.01, 0.001], health: "AMBIGUOUS", health_reason: "", age_s: 0, place: 0.554 } });
    await panel.page.locator(".gauge", { hasText: "two look alike 55 %" }).waitFor({ timeout: 3000 });
  })),
  ...(await small("frozen", kSmall, async (panel) => {
    vehicle.hold(true);  // the socket stays open, nothing comes
    await panel.page.locator("[data-connection=lost]").waitFor({ timeout: 4000 });
    await panel.page.locator(".map-canvas[data-vehicle=old]").waitFor({ timeout: 2000 });
    vehicle.hold(false);
    await panel.page.locator("[data-state]").waitFor({ timeout: 4000 });
  })),
  ...(await small("11", kSmall, async (panel) => {
    await standWithReason(panel);
    await touch(panel, "By hand", { role: "tab" });
    for (const name of ["Forward", "Backward", "Turn left", "Turn right"]) await within(panel, `button[aria-label="${name}"]`, { least_px: 92 });
  })),
  ...(await small("12", kSmall, async (panel) => {
    const place = async () => (await panel.page.getByRole("button", { name: "New order" }).boundingBox()).y;
    const before = await place();
    const long = { code: "held-back", values: {}, text: "x" };
    vehicle.say({ state: "waiting", cause: long, remedy: { code: "look-and-resume", values: {}, text: "x" } });
    await panel.page.locator("[data-cause=held-back]").waitFor();
    expect((await place()) === before, `the button jumped by ${(await place()) - before} px`);
    vehicle.say({ state: "waiting", cause: { code: "loading", values: {}, text: "x" }, remedy: { code: "go-on", values: {}, text: "x" } });
    await panel.page.locator("[data-cause=loading]").waitFor();
    expect((await place()) === before, `the button jumped by ${(await place()) - before} px while loading`);
    await within(panel, ".command.go-on", { least_px: 90 });
  })),
  // What the remedy asks for can be pressed: "look, then press Resume" before a disabled Resume helps nobody.
  ...(await small("remedy", kSmall, async (panel) => {
    const asks = [["unseen-in-the-way", "look-and-resume", "resume"], ["height-unseen", "look-and-go-on", "go-on"], ["stop-unsure", "look-at-place", "go-on"], ["loading", "go-on", "go-on"]];
    for (const [cause, remedy, button] of asks) {
      vehicle.say({ state: "waiting", cause: { code: cause, values: { node: "4", percent: "64" }, text: "x" }, remedy: { code: remedy, values: {}, text: "x" } });
      await panel.page.locator(`[data-cause=${cause}]`).waitFor();
      await within(panel, `.command.${button}:enabled`, { least_px: 90 });
    }
    await look(panel, "stop-unsure");
  })),
  ...(await small("15", kSmall, async (panel) => {
    await standWithReason(panel);
    await panel.page.locator(".row", { hasText: "Press 1 → Dock 1" }).first().tap();
    await panel.page.getByRole("button", { name: "Earlier" }).waitFor();
    await panel.page.waitForTimeout(200);
    for (const name of ["Earlier", "Later", "Cancel order"]) {
      const box = await panel.page.getByRole("button", { name }).boundingBox();
      const bar = await panel.page.locator(".command-bar").boundingBox();
      expect(box.y >= 0 && box.y + box.height <= bar.y + 1, `${name} lies below the fold: ${box.y} + ${box.height}, bar at ${bar.y}`);
    }
  })),
  ...(await small("17", kSmall, async (panel) => {
    vehicle.answer("/api/statistics", { deliveries: 1, distance_m: 1, driving_s: 1, standing_s: 1, since: 1, stops: ["place-unknown", "drive-fault", "no-way", "unknown-node", "place-ambiguous", "stopped-order"].map((code) => ({ cause: { code, values: {}, text: `{${code}}` }, count: 1, seconds: 1 })) });
    await touch(panel, "Look back");
    await touch(panel, "Statistics", { role: "tab" });
    await panel.page.locator(".bars li").first().waitFor();
    expect(!(await panel.page.locator(".bars").innerText()).includes("{"), `the statistics say ${await panel.page.locator(".bars").innerText()}`);
  })),
  ...(await small("19", kSmall, async (panel) => {
    vehicle.say({ state: "fault", cause: { code: "drive-fault", values: { faults: "32 (too hot)", fault_codes: "overtemperature" }, text: "x" }, remedy: { code: "mend-drive", values: {}, text: "x" } });
    await panel.page.locator("[data-cause=drive-fault]").waitFor();
    expect((await panel.page.locator(".state .cause").innerText()).includes("too hot"), `the fault is said as "${await panel.page.locator(".state .cause").innerText()}"`);
    await panel.page.evaluate(() => { localStorage.setItem("madori.language", "ja"); location.reload(); });
    await panel.page.getByText("過熱").waitFor({ timeout: 5000 });
    vehicle.say({ state: "waiting", cause: { code: "something-in-the-way", values: {}, text: "x" }, remedy: { code: "clear-way", values: { reason: "no room to turn" }, text: "x" } });
    await panel.page.locator("[data-cause=something-in-the-way]").waitFor();
    expect(!/[a-z]{4}/.test(await panel.page.locator(".state .remedy").innerText()), `English in Japanese: ${await panel.page.locator(".state .remedy").innerText()}`);
  })),
  ...(await small("20", kPhone, async (panel) => {
    const map = await within(panel, ".map-canvas");
    expect(map.width > 350 && map.height > 250, `the map is ${map.width} x ${map.height} px`);
    await within(panel, ".command.stop", { least_px: 60 });
    await within(panel, ".state");
    await look(panel, "phone-drive");
    await touch(panel, "New order");
    await touch(panel, "Press 1", { exact: true });
    await panel.page.getByRole("button", { name: "Send" }).scrollIntoViewIfNeeded();
    await within(panel, ".new-order .primary", { least_px: 46 });
    vehicle.answer("/api/session", { role: "none", needs_pin: true });
    await panel.page.reload();
    for (const digit of ["1", "6", "0"]) await within(panel, `.login .pad button:text-is("${digit}")`, { least_px: 56 });
    await within(panel, ".command.stop", { least_px: 60 });
    await look(panel, "phone-pin");
  })),
  ...(await small("scrolled", kSmall, async (panel) => {
    const list = panel.page.locator(".tab-panel");
    const top = () => list.evaluate((element) => element.scrollTop);
    await panel.page.locator(".row", { hasText: "Press 1 → Dock 1" }).first().tap();
    await panel.page.getByRole("button", { name: "Earlier" }).waitFor();
    await list.evaluate((element) => element.scrollTo(0, 0));
    await panel.page.waitForTimeout(2500);  // the orders were asked for twice
    expect((await top()) === 0, "the list of orders goes back to the chosen one by itself");
    await list.evaluate((element) => element.scrollTo(0, 300));
    expect((await top()) > 0, "the list of orders is too short for this test");
    await touch(panel, "By hand", { role: "tab" });
    await within(panel, 'button[aria-label="Turn left"]', { least_px: 92 });
    await touch(panel, "Orders", { role: "tab" });
    await touch(panel, "New order");
    await within(panel, ".new-order .primary", { least_px: 92 });
  })),
  ...(await small("login", kSmall, async (panel) => {
    vehicle.answer("/api/session", { role: "none", needs_pin: true });
    await panel.page.reload();
    await panel.page.locator(".login").waitFor();
    for (const button of ['.login .pad button:text-is("0")', ".login [type=submit]", ".login .asked button", ".command.stop"]) await within(panel, button, { least_px: 90 });
  })),
  ...(await small("focus", kSmall, async (panel) => {
    await panel.page.locator(".rail button").first().focus();
    const seen = [];
    for (let i = 0; i < 40; ++i) {
      seen.push(await panel.page.evaluate(() => document.activeElement?.closest(".rail, .map, .state, .tabbed, .command-bar")?.className.split(" ").find((name) => ["rail", "map", "state", "tabbed", "command-bar"].includes(name)) ?? ""));
      await panel.page.keyboard.press("Tab");
    }
    const order = seen.filter((name, i) => name !== "" && name !== seen[i - 1]).slice(0, 5);
    expect(order.join() === "rail,map,state,tabbed,command-bar", `the focus goes ${order.join(", ")}`);
  })),
];
await browser.close();
vehicle.stop();
if (failed.length > 0) {
  console.error(failed.join("\n"));
  process.exit(1);
}

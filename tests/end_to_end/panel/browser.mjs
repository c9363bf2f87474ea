// A touch panel: Debian's Chromium with touch events, which counts every touch and remembers every console error.
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const web = fileURLToPath(new URL("../../../hmi/web/package.json", import.meta.url));
const require = createRequire(web);
export const kChromium = "/usr/bin/chromium";
export const kQuiet = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];

/** Ends the test as skipped (ctest's SKIP_RETURN_CODE) where something it needs is not installed, or `built` holds no page. */
export function skipUnlessInstalled(built = null) {
  const playwright = (() => {
    try {
      return require("playwright-core");
    } catch {
      return null;
    }
  })();
  if (existsSync(kChromium) && playwright) {
    if (built === null || existsSync(join(built, "index.html"))) return playwright;
    console.log(`skipped: ${built} holds no built page (cmake --build build/release --target panel)`);
    process.exit(77);
  }
  console.log(`skipped: needs ${kChromium} (apt-get install chromium) and hmi/web/node_modules (cd hmi/web && npm ci)`);
  process.exit(77);
}

/** axe-core's findings of any weight. Loaded by the debugger: the page's security policy lets no script in. */
export async function findings(page) {
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(`${readFileSync(require.resolve("axe-core/axe.min.js"), "utf8")}; undefined`);
  return page.evaluate(async () => {
    const { violations } = await window.axe.run(document, { resultTypes: ["violations"] });
    return violations.map((one) => `${one.id} (${one.nodes.slice(0, 3).map((node) => `${node.target.join(" ")}: ${node.any[0]?.message ?? ""}`).join("; ")})`);
  });
}

export async function openBrowser() {
  return skipUnlessInstalled().chromium.launch({
    executablePath: kChromium,
    args: kQuiet,
  });
}

/** A page of a panel; `touches` counts what a person's fingers do, `errors` holds what the console complained about. */
export async function openPanel(browser, address, { width, height, language = "en", theme = "light" }) {
  const context = await browser.newContext({ viewport: { width, height }, hasTouch: true, deviceScaleFactor: 1, locale: language === "ja" ? "ja-JP" : "en-GB", acceptDownloads: true });
  const page = await context.newPage();
  page.setDefaultTimeout(Number(process.env["PATIENCE_MS"] ?? 60_000));
  const panel = { page, context, touches: 0, errors: [] };
  await page.exposeFunction("countTouch", () => ++panel.touches);
  await page.addInitScript(([words, shade]) => {
    if (!localStorage.getItem("madori.language")) localStorage.setItem("madori.language", words);
    if (!localStorage.getItem("madori.theme")) localStorage.setItem("madori.theme", shade);
    addEventListener("touchstart", (event) => event.touches.length === 1 && window.countTouch(), { capture: true, passive: true });
  }, [language, theme]);
  page.on("console", (message) => message.type() === "error" && panel.errors.push(`${message.text()} ${message.location().url}`));
  page.on("pageerror", (error) => panel.errors.push(String(error)));
  await page.goto(address);
  return panel;
}

/** A button by what it says (or by its aria-label), touched. */
export async function touch(panel, name, options = {}) {
  const target = panel.page.getByRole(options.role ?? "button", { name, exact: options.exact ?? false });
  await target.first().waitFor();
  await target.first().tap();
}

/** Where a place of the map (or a photograph) is on the screen, in pixels of the page. `nth`: which map of the page. */
export async function pixelOf(panel, place, nth = 0) {
  return panel.page.evaluate(([at, index]) => {
    const target = document.querySelectorAll(".map-canvas")[index];
    const [u, v] = target.olMap.getPixelFromCoordinate(at);
    const box = target.getBoundingClientRect();
    return { x: box.x + u, y: box.y + v };
  }, [place, nth]);
}

/** Waits until a map has been drawn, the drawing on it, its view stands and nothing of it is loading. */
export async function mapReady(panel, nth = 0) {
  await panel.page.waitForFunction((index) => {
    const target = document.querySelectorAll(".map-canvas")[index];
    const map = target?.olMap;
    return map && target.dataset.drawing !== "coming" && map.getSize()?.[0] > 0 && !map.getView().getAnimating();
  }, nth);
  await panel.page.evaluate((index) => new Promise((done) => {
    const map = document.querySelectorAll(".map-canvas")[index].olMap;
    map.once("rendercomplete", () => done());
    map.render();
  }), nth);
}

/** The pixel of a place of the map, once it is on the screen; it must not lie under a button. */
async function shownPixel(panel, place, nth) {
  await panel.page.waitForFunction(([at, index]) => {
    const { olMap } = document.querySelectorAll(".map-canvas")[index] ?? {};
    const [u, v] = olMap?.getPixelFromCoordinate(at) ?? [-1, -1];
    const [width, height] = olMap?.getSize() ?? [0, 0];
    return u > 0 && v > 0 && u < width && v < height;
  }, [place, nth], { timeout: 10_000 }).catch(() => { throw new Error(`${place} lies outside the map that is shown`); });
  const pixel = await pixelOf(panel, place, nth);
  const covered = await panel.page.evaluate(({ x, y }) => document.elementFromPoint(x, y)?.closest("button")?.ariaLabel ?? null, pixel);
  expect(covered === null, `${place} lies under the button "${covered}"`);
  return pixel;
}

export async function touchMap(panel, place, nth = 0) {
  const { x, y } = await shownPixel(panel, place, nth);
  await panel.page.touchscreen.tap(x, y);
}

/** A finger that rests on a place of the map until the magnifier has come. */
export async function restOnMap(panel, place, nth = 0) {
  const pixel = await shownPixel(panel, place, nth);
  const session = await panel.context.newCDPSession(panel.page);
  await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [pixel] });
  await panel.page.locator(".loupe:not([hidden])").waitFor();
  await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  await session.detach();
}

/** A finger that goes down at one pixel, moves in steps and goes up at another. */
export async function dragFinger(panel, from, to, steps = 6) {
  const session = await panel.context.newCDPSession(panel.page);
  const send = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await send("touchStart", [from]);
  for (let i = 1; i <= steps; ++i) await send("touchMove", [{ x: from.x + ((to.x - from.x) * i) / steps, y: from.y + ((to.y - from.y) * i) / steps }]);
  await send("touchEnd", []);
  await session.detach();
}

/** Asks the server from within the page: `status` and `json` of its answer. */
export const askServer = async (panel, method, path, body) => panel.page.evaluate(async ([how, where, what]) => {
  const answer = await fetch(where, { method: how, body: what === undefined ? undefined : JSON.stringify(what) });
  return { status: answer.status, json: await answer.json().catch(() => null) };
}, [method, path, body]);

/** Waits until `ask` holds; how long it took, seconds. */
export async function until(what, ask, limit_ms = 20_000) {
  const begun = Date.now();
  while (Date.now() - begun < limit_ms) {
    if (await ask()) return (Date.now() - begun) / 1000;
    await new Promise((again) => setTimeout(again, 100));
  }
  throw new Error(`not within ${limit_ms / 1000} s: ${what}`);
}

export function expect(condition, message) {
  if (!condition) throw new Error(message);
}

// What the programs of this folder share: their arguments, the browser, and how they end.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { expect, openBrowser, openPanel, skipUnlessInstalled } from "./browser.mjs";
import { stopAll } from "./processes.mjs";

const [madori, page, data, shots, size = "1280x800"] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
/** the program `madori`, the built page, the project's data, the folder for pictures, the panel's size */
export const given = { madori, page, data, shots, size, width, height };

let shown = null; // for a picture of what a person would see when it fails

/** Opens a panel of the given size; the first one is pictured when the program fails. */
export async function openGivenPanel(browser, address, more = {}) {
  const panel = await openPanel(browser, address, { width, height, ...more });
  shown ??= panel;
  return panel;
}

export const picture = (panel, name) => panel.page.screenshot({ path: join(shots, `${name}-${size}.png`) });

export function expectQuietConsole(panel) {
  expect(panel.errors.length === 0, `the console complained: ${panel.errors.slice(0, 5).join("; ")}`);
}

/** Runs `main(browser)`: ends 0, 77 where something is not installed, else 1 with a picture. */
export async function run(main) {
  skipUnlessInstalled(page);
  mkdirSync(shots, { recursive: true });
  const browser = await openBrowser();
  try {
    await main(browser);
  } catch (error) {
    console.error(error);
    await shown?.page.screenshot({ path: join(shots, `failed-${size}.png`) }).catch(() => undefined);
    process.exitCode = 1;
  }
  await browser.close().catch(() => undefined);
  await stopAll();
  process.exit();
}

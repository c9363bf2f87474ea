// For whoever changes the page: pictures of its pages. node look.mjs ADDRESS FOLDER [WIDTHxHEIGHT] [en|ja] [light|dark]
import { openBrowser, openPanel, touch } from "./browser.mjs";

const [address, folder, size = "1280x800", language = "en", theme = "light"] = process.argv.slice(2);
const [width, height] = size.split("x").map(Number);
const browser = await openBrowser();
const panel = await openPanel(browser, address, { width, height, language, theme });
const tag = `${size}-${language}-${theme}`;
const shot = (name) => panel.page.screenshot({ path: `${folder}/${name}-${tag}.png` });
const names = language === "ja"
  ? { drive: "運転", setup: "設定", history: "記録", steps: ["図面", "縮尺", "経路", "車両", "現在地"], tabs: ["手動操作", "直前の30秒"], stats: "統計", files: "ダウンロード" }
  : { drive: "Drive", setup: "Set up", history: "Look back", steps: ["Drawing", "Scale", "Routes", "Vehicle", "Place"], tabs: ["By hand", "Last 30 s"], stats: "Statistics", files: "Downloads" };
const pause = () => panel.page.waitForTimeout(1200);
await touch(panel, names.drive);
await pause();
await shot("drive");
for (const [i, tab] of names.tabs.entries()) { await touch(panel, tab, { role: "tab" }); await pause(); await shot(`drive-${i}`); }
await touch(panel, names.history); await pause(); await shot("history");
await touch(panel, names.stats, { role: "tab" }); await pause(); await shot("statistics");
await touch(panel, names.files, { role: "tab" }); await pause(); await shot("files");
await touch(panel, names.setup); await pause();
for (const [i, step] of names.steps.entries()) {
  await panel.page.locator(".steps button").nth(i).tap(); await pause(); await shot(`step-${i + 1}`);
}
console.log("errors:", panel.errors);
await browser.close();

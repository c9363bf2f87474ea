import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { describe, expect, it } from "vitest";
import { en } from "../src/i18n/en";
import { ja } from "../src/i18n/ja";

const placeholders = (text: string) => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name).sort();
const sources = (folder: string): string[] =>
  readdirSync(folder, { withFileTypes: true }).flatMap((entry) =>
    entry.isDirectory() ? sources(join(folder, entry.name)) : /\.tsx?$/.test(entry.name) ? [join(folder, entry.name)] : [],
  );

describe("the catalogues", () => {
  it("have the same keys and placeholders, and no empty text", () => {
    expect(Object.keys(ja).sort()).toEqual(Object.keys(en).sort());
    for (const [key, text] of Object.entries(en)) {
      const other = ja[key as keyof typeof en];
      expect(other.trim(), key).not.toBe("");
      expect(placeholders(other), key).toEqual(placeholders(text));
    }
  });

  it("are used: no key stands there for nothing", () => {
    const code = sources(new URL("../src", import.meta.url).pathname).filter((file) => !file.includes("i18n/")).map((file) => readFileSync(file, "utf8")).join("\n");
    const composed = ["nav.", "command.", "state.", "health.", "order.", "setup.", "scale.verdict.", "error.", "cause.", "remedy."];
    const unused = Object.keys(en).filter((key) => !composed.some((prefix) => key.startsWith(prefix)) && !code.includes(`"${key}"`));
    expect(unused).toEqual([]);
  });
});

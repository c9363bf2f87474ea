import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import ts from "typescript";
import { describe, expect, it } from "vitest";
import { de } from "../src/i18n/de";
import { en } from "../src/i18n/en";
import { ja } from "../src/i18n/ja";

const placeholders = (text: string) => [...text.matchAll(/\{(\w+)\}/g)].map(([, name]) => name).sort();
const sources = (folder: string): string[] =>
  readdirSync(folder, { withFileTypes: true }).flatMap((entry) =>
    entry.isDirectory() ? sources(join(folder, entry.name)) : /\.tsx?$/.test(entry.name) ? [join(folder, entry.name)] : [],
  );
const files = sources(new URL("../src", import.meta.url).pathname).filter((file) => !file.includes("i18n/") && !file.endsWith("api_types.ts"));

/** The beginnings of keys that are put together in the code: `state.${state}`. */
const composed = () => files.flatMap((file) => [...readFileSync(file, "utf8").matchAll(/`([a-z_.]+\.)\$\{/g)].map(([, prefix]) => prefix ?? ""));
const fromTheVehicle = ["error.", "cause.", "remedy.", "finding.", "reason.", "order.", "device-", "scale-", "event.", "saved.", "braking.", "mounting.", "view."];

/** What the vehicle's own code can say: the codes in its C++ tables and refusals, as the panel's keys. */
function saidByTheVehicle(): string[] {
  const root = new URL("../../..", import.meta.url).pathname;
  const cpp = (folder: string): string[] =>
    readdirSync(join(root, folder), { withFileTypes: true }).flatMap((entry) =>
      entry.isDirectory() ? cpp(join(folder, entry.name)) : /\.[ch]pp$/.test(entry.name) ? [readFileSync(join(root, folder, entry.name), "utf8")] : [],
    );
  const found = (text: string, pattern: RegExp, prefix: string) => [...text.matchAll(pattern)].map(([, code]) => `${prefix}.${code}`);
  const notices = readFileSync(join(root, "app/cycle/notice.hpp"), "utf8");
  const remedies = notices.indexOf("kRemedies");
  const panel = [...cpp("hmi/server"), ...cpp("app/panel")].join("\n");
  return [
    ...found(notices.slice(0, remedies), /CatalogueEntry\{"([\w-]+)"/g, "cause"),
    ...found(notices.slice(remedies), /CatalogueEntry\{"([\w-]+)"/g, "remedy"),
    ...found(readFileSync(join(root, "planning/route_graph/finding_texts.hpp"), "utf8"), /FindingText\{"([\w-]+)"/g, "finding"),
    ...found(readFileSync(join(root, "localization/health/reasons.hpp"), "utf8"), /Reason k\w+\{\s*"([\w-]+)"/g, "reason"),
    ...found(readFileSync(join(root, "app/braking/braking_test.cpp"), "utf8"), /CatalogueEntry\{"([\w-]+)"/g, "braking"),
    ...found(panel, /(?:Response::error|refused)\((?:\d+,\s*)?"([\w-]+)"/g, "error"),
    ...found(readFileSync(join(root, "app/mounting/mounting_words.hpp"), "utf8"), /CatalogueEntry k\w+\{\s*"([\w-]+)"/g, "mounting"),
    ...found(readFileSync(join(root, "mapping/site/site_versions.cpp"), "utf8"), /\badd\("([\w-]+)"\)/g, "saved"),
  ];
}

/** Said in the vehicle's English: what it holds has no fixed form. */
const inEnglish = ["error.refused", "error.internal"];

/** A word that a person would read: two letters in a row. */
const isWord = (text: string) => /\p{L}{2}/u.test(text);
const visibleAttributes = new Set(["aria-label", "title", "placeholder", "alt", "label"]);

/** Strings that reach the screen without a catalogue: words between tags, in what {…} yields between tags, in visible attributes. */
export function visibleTexts(code: string): string[] {
  const found: string[] = [];
  const yielded = (node: ts.Node): void => {
    if (ts.isStringLiteralLike(node) && isWord(node.text)) found.push(node.text);
    else if (ts.isTemplateExpression(node)) {
      for (const part of [node.head, ...node.templateSpans.map((span) => span.literal)]) if (isWord(part.text)) found.push(part.text);
      node.templateSpans.forEach((span) => yielded(span.expression));
    } else if (ts.isConditionalExpression(node)) {
      yielded(node.whenTrue);
      yielded(node.whenFalse);
    } else if (ts.isBinaryExpression(node)) {
      if (node.operatorToken.kind === ts.SyntaxKind.PlusToken) yielded(node.left);
      yielded(node.right);
    } else if (ts.isParenthesizedExpression(node)) yielded(node.expression);
  };
  const visit = (node: ts.Node): void => {
    if (ts.isJsxText(node) && isWord(node.text)) found.push(node.text.trim());
    if (ts.isJsxExpression(node) && node.expression && !ts.isJsxAttribute(node.parent)) yielded(node.expression);
    if (ts.isJsxAttribute(node) && visibleAttributes.has(node.name.getText()) && node.initializer) {
      if (ts.isStringLiteral(node.initializer)) yielded(node.initializer);
      else if (ts.isJsxExpression(node.initializer) && node.initializer.expression) yielded(node.initializer.expression);
    }
    ts.forEachChild(node, visit);
  };
  visit(ts.createSourceFile("x.tsx", code, ts.ScriptTarget.Latest, true, ts.ScriptKind.TSX));
  return found;
}

describe("the catalogues", () => {
  it("have the same keys and placeholders, and no empty text", () => {
    for (const texts of [de, ja]) {
      expect(Object.keys(texts).sort()).toEqual(Object.keys(en).sort());
      for (const [key, text] of Object.entries(en)) {
        const other = texts[key as keyof typeof en];
        expect(other.trim(), key).not.toBe("");
        expect(placeholders(other), key).toEqual(placeholders(text));
      }
    }
  });

  const buttons = ["command.start", "command.pause", "command.resume", "command.stop", "command.confirm", "command.go-on"] as const;

  it("give the commands of the vehicle names that no other button of a page has", () => {
    for (const texts of [en, de, ja]) {
      const names = [...buttons, "setup.next" as const, "setup.save_next" as const].map((key) => texts[key].toLowerCase());
      expect(new Set(names).size, names.join(", ")).toBe(names.length);
    }
  });

  it("call a button by its own name where they tell a person to press it", () => {
    let told = 0;
    for (const [key, text] of Object.entries(en))
      for (const button of buttons.filter((one) => new RegExp(`press ${en[one]}\\b`, "i").test(text))) {
        ++told;
        for (const texts of [de, ja]) expect(texts[key as keyof typeof en], key).toContain(texts[button]);
      }
    expect(told).toBeGreaterThan(8);
  });

  it("know everything that the vehicle can say by a code", () => {
    const said = saidByTheVehicle();
    for (const kind of ["cause", "remedy", "finding", "reason", "error"]) expect(said.filter((key) => key.startsWith(`${kind}.`)).length, kind).toBeGreaterThan(10);
    expect(said.filter((key) => !(key in en) && !inEnglish.includes(key))).toEqual([]);
  });

  it("name no value that the vehicle does not send with it", () => {
    const root = new URL("../../..", import.meta.url).pathname;
    const notices = readFileSync(join(root, "app/cycle/notice.hpp"), "utf8").replace(/"\s*\n\s*"/g, "");
    const sent = new Map([...notices.matchAll(/CatalogueEntry\{"([\w-]+)",\s*"([^"]*)"/g)].map(([, code, text]) => [code ?? "", placeholders(text ?? "")]));
    expect(sent.size).toBeGreaterThan(40);
    for (const [code, names] of sent)
      for (const key of [`cause.${code}`, `remedy.${code}`]) if (key in en) expect(placeholders(en[key as keyof typeof en]), key).toEqual(names);
  });

  it("are used: no key stands there for nothing", () => {
    const code = files.map((file) => readFileSync(file, "utf8")).join("\n");
    const prefixes = [...composed(), ...fromTheVehicle];
    const unused = Object.keys(en).filter((key) => !prefixes.some((prefix) => key.startsWith(prefix)) && !code.includes(`"${key}"`));
    expect(unused).toEqual([]);
  });

  it("hold every text that a person sees", () => {
    const outside = files.filter((file) => file.endsWith(".tsx")).flatMap((file) => visibleTexts(readFileSync(file, "utf8")).map((text) => `${file}: ${text}`));
    expect(outside).toEqual([]);
  });

  it("would not be evaded by any way of writing a text", () => {
    expect(visibleTexts("<p>Stop</p>")).toEqual(["Stop"]);
    expect(visibleTexts("<p>{bad && 'Stop'}{a ? 'One' : t('two')}{`${n} left`}</p>")).toEqual(["Stop", "One", " left"]);
    expect(visibleTexts("<button aria-label='Stop' class='red' onClick={() => go('drive')}>{t('command.stop')}</button>")).toEqual(["Stop"]);
  });
});

import { Store, useStore } from "../store";
import { en, type TextKey } from "./en";

type Texts = Record<TextKey, string>;

/** A language is one file beside this one, named by its code (BCP 47), that exports its texts. */
const files = import.meta.glob<Record<string, Texts>>(["./*.ts", "!./index.ts"], { eager: true });
const catalogues: Record<string, Texts> = Object.fromEntries(
  Object.entries(files).map(([file, module]) => [file.slice(2, -3), Object.values(module)[0] ?? en]),
);
const languages = ["en", ...Object.keys(catalogues).filter((code) => code !== "en").sort()];

const stored = localStorage.getItem("madori.language") ?? "";
const preferred = languages.find((code) => navigator.language.startsWith(code)) ?? "en";
export const language = new Store<string>(languages.includes(stored) ? stored : preferred);
language.watch((value) => {
  localStorage.setItem("madori.language", value);
  document.documentElement.lang = value;
});
document.documentElement.lang = language.value;

const catalogue = (code: string): Texts => catalogues[code] ?? en;
export const nextLanguage = (): string => languages[(languages.indexOf(language.value) + 1) % languages.length] ?? "en";
export const textIn = (code: string, key: TextKey): string => catalogue(code)[key];

type Values = Record<string, string | number>;

function fill(text: string, values: Values): string {
  return text.replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

export type Translate = (key: TextKey, values?: Values) => string;

/** The text of a key in the chosen language. */
export function useText(): Translate {
  const chosen = useStore(language);
  return (key, values = {}) => fill(catalogue(chosen)[key], values);
}

export { kindText, noticeText } from "../notice_text";

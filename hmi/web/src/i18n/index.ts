import type { Notice } from "../api_types";
import { Store, useStore } from "../store";
import { en, type TextKey } from "./en";
import { ja } from "./ja";

export type Language = "en" | "ja";
const catalogues: Record<Language, Record<TextKey, string>> = { en, ja };

const stored = localStorage.getItem("madori.language");
const preferred: Language = navigator.language.startsWith("ja") ? "ja" : "en";
export const language = new Store<Language>(stored === "en" || stored === "ja" ? stored : preferred);
language.watch((value) => {
  localStorage.setItem("madori.language", value);
  document.documentElement.lang = value;
});
document.documentElement.lang = language.value;

type Values = Record<string, string | number>;

function fill(text: string, values: Values): string {
  return text.replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

export type Translate = (key: TextKey, values?: Values) => string;

/** The text of a key in the chosen language. */
export function useText(): Translate {
  const chosen = useStore(language);
  return (key, values = {}) => fill(catalogues[chosen][key], values);
}

/** The values with the {reason} in the chosen language, where its codes (the outer one first) are known. */
function withReason(t: Translate, values: Record<string, string>): Record<string, string> {
  const keys = (values["reason_codes"] ?? "").split("+").map((code) => `reason.${code}`);
  return keys.every((key) => key in en) ? { ...values, reason: keys.map((key) => t(key as TextKey)).join(" ") } : values;
}

/** A notice of the vehicle: from the catalogue where it is known, else in the vehicle's own English. */
export function noticeText(t: Translate, prefix: string, notice: Notice): string {
  const key = [`${prefix}.${notice.code}`, notice.code].find((one) => one in en);
  return key === undefined ? notice.text : t(key as TextKey, withReason(t, notice.values));
}

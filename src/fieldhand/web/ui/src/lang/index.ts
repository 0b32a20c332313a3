// The page's own words, in the language of the reader.

import { en, type Key } from "./en";
import { es } from "./es";
import { remembered } from "../lib/kept";

const DICTIONARIES: Record<string, Record<Key, string>> = { en, es };

export const LANGUAGES: [code: string, name: string][] = [
  ["en", "English"],
  ["es", "Español"],
];

let code = chosen();

function chosen(): string {
  const wanted = remembered<string>("language", navigator.language.slice(0, 2));
  return wanted in DICTIONARIES ? wanted : "en";
}

export const current = (): string => code;

export function use(language: string): void {
  code = language in DICTIONARIES ? language : "en";
}

// The words of a key, with {names} filled in. A key with a count has two forms: `key` for one, `key_many` for others.
export function t(key: Key, values: Record<string, string | number> = {}): string {
  const words = DICTIONARIES[code]![key];
  return words.replace(/\{(\w+)\}/g, (whole, name: string) => (name in values ? String(values[name]) : whole));
}

// The words of a status of a mission; a status that is not known is shown as it is.
export function statusWords(status: string): string {
  return DICTIONARIES[code]![`status_${status}` as Key] ?? status;
}

type Counted = { [K in Key]: `${K}_many` extends Key ? K : never }[Key];

export function tn(key: Counted, count: number, values: Record<string, string | number> = {}): string {
  return t(count === 1 ? key : (`${key}_many` as Key), { count, ...values });
}

export type { Key };

// Numbers, times and lengths in words of the page's language.

import { current } from "../lang";

export const number = (value: number, digits = 0): string =>
  new Intl.NumberFormat(current(), { maximumFractionDigits: digits }).format(value);

export const metres = (value: number): string => (value >= 10_000 ? `${number(value / 1000, 1)} km` : `${number(value)} m`);

export function duration(seconds: number): string {
  if (seconds < 90) return `${number(seconds)} s`;
  return seconds < 5400 ? `${number(seconds / 60)} min` : `${number(seconds / 3600, 1)} h`;
}

// Minutes and seconds of a mission.
export function clock(seconds: number): string {
  const whole = Math.max(Math.floor(seconds), 0);
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  const two = (value: number) => String(value).padStart(2, "0");
  return h ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}`;
}

const UNITS: Record<string, string> = { degC: "°C", percent: "%" };

// A unit of a profile as people write it.
export const unitSign = (unit: string): string => UNITS[unit] ?? unit;

// The name of an action or a quantity as words.
export const spaced = (name: string): string => name.replaceAll("_", " ");

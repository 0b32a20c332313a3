// What came of a mission: outcomes of its goals, the map by reading, a table, a chart, and downloads.

import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

import { current, t } from "../lang";
import { el, replace, save, type Child } from "../lib/dom";
import { clock, number, spaced, unitSign } from "../lib/figures";
import type { Feature, Goal } from "../lib/types";
import type { Capture } from "../map/drive_layer";
import type { FieldMap } from "../map/field_map";
import { Scale } from "../map/scale";
import type { Projection } from "../map/geometry";

const MARKS = { success: "✓", failure: "✗", indeterminate: "?" };
const MOST_ROWS = 500; // of a table on the page; a file has them all

export const captureOf = (feature: Feature, projection: Projection): Capture => ({
  ...(feature.properties as unknown as Capture),
  at: projection.metres(feature.geometry.coordinates as [number, number]),
});

export const goalList = (goals: Goal[]): HTMLElement =>
  el(
    "ul",
    { class: "goals" },
    goals.map(({ outcome, name, why }) =>
      el("li", { class: outcome }, el("span", { class: "mark", "aria-hidden": "true" }, MARKS[outcome] ?? "?"), el("span", {}, el("span", { class: "sr" }, `${t(outcome)}: `), `${name}: ${why}`)),
    ),
  );

const quantities = (captures: Capture[]): string[] => [...new Set(captures.flatMap(({ readings }) => Object.keys(readings)))].sort();

const unitOf = (captures: Capture[], quantity: string): string => unitSign(captures.find(({ units }) => units[quantity])?.units[quantity] ?? "");

// A choice of the reading that colours the map, its colours, and the readings over time.
export function readingChooser(captures: Capture[], map: FieldMap): HTMLElement | null {
  const names = quantities(captures);
  if (!names.length) return null;
  const key = el("div", { class: "scale" });
  const chart = el("div", { class: "chart" });
  const select = el("select", { id: "colour-by" }, names.map((name) => el("option", { value: name }, spaced(name))), el("option", { value: "" }, t("by_outcome")));
  const show = () => {
    const quantity = select.value;
    const scale = Scale.of(captures.map(({ readings }) => readings[quantity] ?? NaN));
    map.drive.colourBy(quantity, scale);
    replace(key, scale && colourKey(scale, unitOf(captures, quantity)));
    replace(chart);
    if (scale) drawChart(chart, captures, quantity);
  };
  select.addEventListener("change", show);
  requestAnimationFrame(show);
  return el("div", { class: "readings" }, el("div", { class: "field" }, el("label", { for: "colour-by" }, t("colour_by")), select), key, chart);
}

function colourKey({ least, most }: Scale, unit: string): Child[] {
  const canvas = el("canvas", { width: 160, height: 12, class: "ramp", "aria-hidden": "true" });
  const context = canvas.getContext("2d");
  const scale = new Scale(0, 159);
  for (let x = 0; context && x < 160; x++) {
    context.fillStyle = scale.colour(x);
    context.fillRect(x, 0, 1, 12);
  }
  return [el("span", {}, number(least, 1)), canvas, el("span", {}, `${number(most, 1)} ${unit}`)];
}

function drawChart(parent: HTMLElement, captures: Capture[], quantity: string): void {
  const read = captures.filter(({ readings }) => readings[quantity] !== undefined).sort((a, b) => a.t - b.t);
  if (read.length < 2) return;
  const style = getComputedStyle(document.documentElement);
  const [ink, line, drive] = ["--quiet", "--line", "--drive"].map((name) => style.getPropertyValue(name).trim()) as [string, string, string];
  const axis = { stroke: ink, grid: { stroke: line, width: 1 }, ticks: { stroke: line, width: 1 }, font: "12px system-ui" };
  const unit = unitOf(captures, quantity);
  const chart = new uPlot(
    {
      width: Math.max(parent.clientWidth, 240),
      height: 180,
      scales: { x: { time: false } },
      legend: { show: false },
      cursor: { drag: { x: false, y: false } },
      axes: [
        { ...axis, values: (_, values) => values.map(clock) },
        { ...axis, size: 56, values: (_, values) => values.map((value) => number(value, 1)) },
      ],
      series: [{}, { label: spaced(quantity), stroke: drive, width: 2, points: { show: true, size: 7, fill: drive } }],
    },
    [read.map((capture) => capture.t), read.map((capture) => capture.readings[quantity]!)],
    parent,
  );
  chart.root.setAttribute("role", "img");
  chart.root.setAttribute("aria-label", `${spaced(quantity)}${unit ? ` (${unit})` : ""}, ${t("over_time")}`);
  new ResizeObserver(() => parent.clientWidth && chart.setSize({ width: parent.clientWidth, height: 180 })).observe(parent);
}

// The captures as a table; a row, when touched, shows its place on the map.
export function captureTable(captures: Capture[]): HTMLElement | null {
  if (!captures.length) return null;
  const names = quantities(captures);
  const head = [t("time"), t("place"), t("action"), ...names.map((name) => `${spaced(name)} ${unitOf(captures, name)}`.trim()), t("outcome")];
  const row = (one: Capture) => [clock(one.t), one.place, spaced(one.action), ...names.map((name) => (one.readings[name] === undefined ? "" : number(one.readings[name], 2))), outcomeWord(one.status)];
  return el(
    "details",
    { class: "more", open: captures.length <= 12 },
    el("summary", {}, `${t("captures")} (${captures.length})`),
    el(
      "div",
      { class: "scroll", tabindex: 0, role: "group", "aria-label": t("captures") },
      el(
        "table",
        { class: "captures" },
        el("thead", {}, el("tr", {}, head.map((name) => el("th", { scope: "col" }, name)))),
        el("tbody", {}, captures.slice(0, MOST_ROWS).map((one) => el("tr", { class: one.status === "success" ? false : "failed" }, row(one).map((cell) => el("td", {}, cell))))),
      ),
    ),
    captures.length > MOST_ROWS ? el("p", { class: "hint" }, t("more_in_files")) : null,
  );
}

const outcomeWord = (status: string): string => (status === "success" ? t("success") : spaced(status));

// Files for a spreadsheet and a GIS, made here from the captures on the map.
export function resultFiles(captures: Feature[], log: string): HTMLElement {
  return el(
    "div",
    { class: "buttons" },
    el("button", { type: "button", onclick: () => save("observations.csv", "text/csv", csv(captures)) }, t("download", { name: "observations.csv" })),
    el("button", { type: "button", onclick: () => save("results.geojson", "application/geo+json", JSON.stringify({ type: "FeatureCollection", features: captures }, null, 1)) }, t("download", { name: "results.geojson" })),
    el("button", { type: "button", onclick: () => save("events.jsonl", "application/jsonl", log) }, t("download", { name: "events.jsonl" })),
  );
}

export function csv(captures: Feature[]): string {
  const names = [...new Set(captures.flatMap(({ properties }) => Object.keys(properties["readings"] ?? {})))].sort();
  const units = names.map((name) => captures.find(({ properties }) => properties["units"]?.[name])?.properties["units"][name] ?? "");
  const head = ["t_s", "place", "action", "status", "lat", "lon", ...names.map((name, k) => (units[k] ? `${name} (${units[k]})` : name))];
  const rows = captures.map(({ geometry, properties: p }) => {
    const [lon, lat] = geometry.coordinates as [number, number];
    return [p["t"], p["place"], p["action"], p["status"], lat, lon, ...names.map((name) => p["readings"]?.[name] ?? "")];
  });
  return [head, ...rows].map((row) => row.map(cell).join(",")).join("\r\n") + "\r\n";
}

// A cell that a spreadsheet takes as text, never as a formula.
function cell(value: unknown): string {
  if (typeof value === "number") return String(value);
  const text = /^[=+\-@\t\r]/.test(String(value)) ? `'${value}` : String(value);
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

export const localTime = (iso: string): string => {
  const at = new Date(iso);
  return Number.isNaN(at.getTime()) ? iso : new Intl.DateTimeFormat(current(), { dateStyle: "medium", timeStyle: "short" }).format(at);
};

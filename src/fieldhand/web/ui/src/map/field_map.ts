// The map of a page: a site, a plan on it, a drive over it. Leaflet moves and zooms; the layers are drawn here.

import L from "leaflet";

import { t } from "../lang";
import { el, icon } from "../lib/dom";
import { number, spaced, unitSign } from "../lib/figures";
import type { Feature } from "../lib/types";
import { DriveLayer, type Capture, type Robot } from "./drive_layer";
import { boxOf, positions, Projection, type Point } from "./geometry";
import { PlanLayer } from "./plan_layer";
import { SiteLayer } from "./site_layer";

const TOUCH_PX = 22; // a finger is as wide as this around a sign
const SMALL = 0.4; // work in so small a part of the site is looked at from near

export interface MapView {
  center: Point;
  zoom: number;
}

export class FieldMap {
  readonly root: HTMLElement;
  readonly info: HTMLElement;
  readonly plan = new PlanLayer();
  readonly drive = new DriveLayer();
  onview: (view: MapView | null) => void = () => {};
  onstop: (nodes: string[]) => void = () => {};
  onchoice: (number: number) => void = () => {};
  projection: Projection | null = null;
  private readonly map: L.Map;
  private readonly site = new SiteLayer();
  private readonly canvas: HTMLElement;
  private all: Point[] = [];
  private wanted: { points: Point[]; room: number } | null = null; // what is fitted again when the size changes
  private kept: MapView | null = null;

  constructor(title: string) {
    this.canvas = el("div", { class: "map-canvas-box", tabindex: 0, role: "application", "aria-label": `${title}. ${t("map_keys")}` });
    this.info = el("p", { class: "map-info", "aria-live": "polite" });
    this.root = el("div", { class: "map-box" }, this.canvas, this.tools(), this.info);
    this.map = L.map(this.canvas, {
      crs: L.CRS.Simple,
      attributionControl: false,
      zoomControl: false,
      zoomAnimation: false,
      fadeAnimation: false,
      markerZoomAnimation: false,
      zoomSnap: 0,
      zoomDelta: 0.7,
      minZoom: -6,
      maxZoom: 7,
      scrollWheelZoom: false,
      keyboardPanDelta: 60,
      center: [0, 0],
      zoom: 0,
    });
    for (const layer of [this.site, this.plan, this.drive]) layer.addTo(this.map);
    this.map.on("mousemove", ({ latlng }) => this.point(latlng));
    this.map.on("click", ({ latlng }) => this.tap(latlng));
    this.map.on("mouseout", () => this.onstop([]));
    for (const name of ["dragstart", "zoomstart"]) this.map.on(name, () => this.fitting || this.taken());
    this.map.on("moveend", () => this.fitting || this.moved());
    this.canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    new ResizeObserver(() => this.resized()).observe(this.canvas);
  }

  private fitting = false;

  // A site; forgets what was drawn before. Without a view of before, the whole site is shown.
  showSite(features: Feature[], view: MapView | null = null): void {
    this.clearPlan();
    this.projection = Projection.of(features);
    this.all = features.flatMap(positions).map((p) => this.projection!.metres(p));
    this.site.show(features, this.projection);
    this.kept = view;
    if (view) {
      this.wanted = null;
      this.setView(view);
    } else this.fit();
  }

  clear(): void {
    this.clearPlan();
    this.site.clear();
    this.projection = null;
    this.all = [];
  }

  // Legs and stops of a plan.
  showPlan(features: Feature[]): void {
    this.clearPlan();
    if (!this.projection) return;
    this.plan.show(features, this.projection);
    const at = this.plan.stops.map((stop) => stop.at);
    if (at.length && this.isSmall(at) && !this.kept) this.fit(at, 0.5);
  }

  showChoices(features: Feature[]): void {
    this.clearPlan();
    if (this.projection) this.plan.show(features, this.projection);
  }

  clearPlan(): void {
    this.plan.clear();
    this.drive.clear();
    this.info.textContent = "";
  }

  clearDrive(): void {
    this.drive.clear();
    this.plan.setFaint(false);
  }

  setTrack(track: Point[], robot: Robot | null): void {
    this.plan.setFaint(true);
    this.drive.setTrack(track, robot);
  }

  // Marks the stops of these nodes, and says how many there are.
  highlight(nodes: string[]): void {
    this.plan.light(nodes);
  }

  // Moves the view so that the stops of these nodes can be seen.
  reveal(nodes: string[]): void {
    const stops = this.plan.stopsOf(nodes);
    if (!stops.length) return;
    const bounds = this.map.getBounds();
    if (!stops.every(({ at: [x, y] }) => bounds.contains([y, x]))) this.fit(stops.map((stop) => stop.at), 0.5);
  }

  // Everything, or these points with room around them, in view.
  fit(points: Point[] = this.all, room = 0.05): void {
    this.wanted = { points, room };
    this.fitting = true;
    this.map.invalidateSize({ animate: false, pan: false });
    const [west, south, east, north] = boxOf(points);
    const around = Math.max(east - west, north - south, 15) * room + 3;
    this.map.fitBounds([[south - around, west - around], [north + around, east + around]], { animate: false });
    this.fitting = false;
    this.drags();
  }

  private setView({ center: [x, y], zoom }: MapView): void {
    this.fitting = true;
    this.map.setView([y, x], zoom, { animate: false });
    this.fitting = false;
    this.drags();
  }

  // The user has moved the map: it stays where it is.
  private taken(): void {
    this.wanted = null;
  }

  private moved(): void {
    const { lat, lng } = this.map.getCenter();
    this.kept = { center: [lng, lat], zoom: this.map.getZoom() };
    if (this.wanted === null) this.onview(this.kept);
    this.drags();
  }

  private showAll(): void {
    this.kept = null;
    this.fit();
    this.onview(null);
  }

  // On a phone, while the whole site is in view, a finger scrolls the page; else it moves the map.
  private drags(): void {
    const whole = this.wanted !== null && this.wanted.points === this.all;
    const touch = matchMedia("(max-width: 899px) and (pointer: coarse)").matches;
    if (whole && touch) this.map.dragging.disable();
    else this.map.dragging.enable();
  }

  private resized(): void {
    this.fitting = true;
    this.map.invalidateSize({ animate: false, pan: true });
    this.fitting = false;
    if (this.wanted) this.fit(this.wanted.points, this.wanted.room);
  }

  private zoom(by: number): void {
    this.taken();
    this.map.setZoom(this.map.getZoom() + by, { animate: false });
  }

  // Where the map is beside the text, the wheel zooms; above it, it scrolls the page.
  private wheel(event: WheelEvent): void {
    if (!event.ctrlKey && !matchMedia("(min-width: 900px)").matches) return;
    event.preventDefault();
    this.taken();
    const by = -Math.min(Math.max(event.deltaY, -80), 80) * 0.006;
    this.map.setZoomAround(this.map.mouseEventToContainerPoint(event), this.map.getZoom() + by, { animate: false });
  }

  private isSmall(points: Point[]): boolean {
    const [part, whole] = [boxOf(points), boxOf(this.all)];
    return [0, 1].every((axis) => part[axis + 2]! - part[axis]! < SMALL * (whole[axis + 2]! - whole[axis]!));
  }

  private within(): number {
    return TOUCH_PX / 2 ** this.map.getZoom();
  }

  private point({ lat, lng }: L.LatLng): void {
    const at: Point = [lng, lat];
    const stop = this.plan.stopAt(at, this.within() * 0.6);
    this.onstop(stop ? stop.nodes : []);
    const words = this.words(at);
    if (words) this.info.textContent = words;
  }

  private tap({ lat, lng }: L.LatLng): void {
    const at: Point = [lng, lat];
    const choice = this.plan.choiceAt(at, this.within());
    if (choice) this.onchoice(Math.min(...choice.numbers.slice(0, 1)));
    else this.point(L.latLng(lat, lng));
  }

  // What is at a point, in words.
  private words(at: Point): string {
    const capture = this.drive.captureAt(at, this.within());
    if (capture) return captureWords(capture);
    const stop = this.plan.stopAt(at, this.within());
    if (stop) return `${t("stop")} ${stop.number}: ${stop.kind} ${stop.place}${stop.branch ? `, ${t("on_some_branches")}` : ""}`;
    const plant = this.site.plantAt(at, 0.6 * this.within());
    return plant ? plantWords(plant) : "";
  }

  private tools(): HTMLElement {
    const button = (name: string, drawn: SVGSVGElement, onclick: () => void) => el("button", { type: "button", "aria-label": name, title: name, onclick }, drawn);
    return el(
      "div",
      { class: "map-tools", role: "group", "aria-label": t("map") },
      button(t("zoom_in"), icon("M12 5v14M5 12h14"), () => this.zoom(0.7)),
      button(t("zoom_out"), icon("M5 12h14"), () => this.zoom(-0.7)),
      button(t("show_all"), icon("M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5"), () => this.showAll()),
    );
  }
}

export function captureWords({ action, place, status, readings, units }: Capture): string {
  const read = Object.entries(readings).map(([name, value]) => `${spaced(name)} ${number(value, 2)} ${unitSign(units[name] ?? "")}`.trim());
  return [`${spaced(action)}, ${place}`, ...read, status === "success" ? "" : spaced(status)].filter(Boolean).join("; ");
}

const UNSAID = new Set(["id", "row", "marker-symbol", "kind"]);

function plantWords({ properties: { id, row, attributes } }: { properties: Record<string, any> }): string {
  const rest = Object.entries(attributes as Record<string, unknown>)
    .filter(([name]) => !UNSAID.has(name))
    .map(([name, value]) => `${spaced(name)} ${value}`);
  return [`${t("plant")} ${id}`, row ? `${t("row")} ${row}` : "", ...rest].filter(Boolean).join(", ");
}

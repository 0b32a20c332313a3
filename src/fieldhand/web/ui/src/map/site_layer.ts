// The site: zones, blocks, rows, plants, gates and markers, with as many names as have room.

import { spaced } from "../lib/figures";
import type { Feature } from "../lib/types";
import { CanvasLayer, label, LETTERS, trace, type View } from "./canvas_layer";
import { boxOf, distance, middle, type Point, type Projection } from "./geometry";
import { placed, worth, type Rectangle, type Wanted } from "./names";

interface Zone {
  rings: Point[][];
  kind: string;
}

interface Sign {
  text: string;
  at: Point;
}

interface Name {
  text: string;
  at: Point;
  size: number;
  worth: number;
  bold?: boolean;
  number?: number; // of a row
  out?: Point; // direction out of its row
  beside?: boolean;
}

const ROW_STEPS = [1, 2, 5, 10, 20, 50, 100];
const ROW_PX = 22; // least distance between the numbers of two rows
const MARKS: Record<string, string> = { start: "S", end: "E", charger: "C" };

export class SiteLayer extends CanvasLayer {
  private zones: Zone[] = [];
  private blocks: Point[][] = [];
  private rows: { line: Point[]; inferred: boolean }[] = [];
  private plants: Point[] = [];
  private gates: Sign[] = [];
  private markers: Sign[] = [];
  private names: Name[] = [];
  private radius = 1;
  private rowsApart = Infinity;
  private trees: Feature[] = [];

  constructor() {
    super("site");
  }

  show(features: Feature[], projection: Projection): void {
    this.clear();
    for (const feature of features) {
      const { geometry, properties } = feature;
      if (geometry.type === "Polygon") {
        const rings = geometry.coordinates.map((ring) => projection.line(ring));
        if (properties.role === "zone") this.addZone(rings, properties["kind"], properties["name"]);
        if (properties.role === "avoided") this.zones.push({ rings, kind: "avoided" });
        if (properties.role === "block") this.addBlock(rings[0] ?? [], properties["name"]);
      }
      if (geometry.type === "LineString" && properties.role === "row")
        this.rows.push({ line: projection.line(geometry.coordinates), inferred: properties["known"] === "inferred" });
      if (geometry.type === "Point") {
        const at = projection.metres(geometry.coordinates);
        const name = String(properties["name"] ?? "");
        if (properties.role === "tree") {
          this.plants.push(at);
          this.trees.push(feature);
        }
        if (properties.role === "gate") {
          this.gates.push({ text: name, at });
          this.names.push({ text: name, at, size: 12, worth: 2, beside: true });
        }
        if (properties.role === "marker") this.markers.push({ text: MARKS[name] ?? name.charAt(0).toUpperCase(), at });
      }
    }
    this.nameRows(features, projection);
    this.names.sort((a, b) => a.worth - b.worth);
    this.radius = this.plantRadius();
    this.redraw();
  }

  clear(): void {
    this.zones = [];
    this.blocks = [];
    this.rows = [];
    this.plants = [];
    this.gates = [];
    this.markers = [];
    this.names = [];
    this.trees = [];
    this.redraw();
  }

  // The plant nearest to a point, within a distance in metres.
  plantAt(point: Point, within: number): Feature | null {
    let [best, least] = [-1, Math.max(within, this.radius)];
    this.plants.forEach((plant, k) => {
      const away = distance(plant, point);
      if (away < least) [best, least] = [k, away];
    });
    return this.trees[best] ?? null;
  }

  protected paint(view: View): void {
    this.paintZones(view);
    this.paintRows(view);
    this.paintPlants(view);
    const taken = this.paintSigns(view);
    this.paintNames(view, taken);
  }

  private addZone(rings: Point[][], kind: string, name: string): void {
    this.zones.push({ rings, kind });
    if (kind !== "boundary") this.names.push({ text: name || spaced(kind), at: middle(rings[0] ?? []), size: 12, worth: 1 });
  }

  private addBlock(outline: Point[], name: string): void {
    this.blocks.push(outline);
    this.names.push({ text: name, at: middle(outline), size: 13, worth: 3, bold: true });
  }

  // Names at both ends of each row; of many there is room for some, the round numbers first.
  private nameRows(features: Feature[], projection: Projection): void {
    const rows = features.filter((f) => f.properties.role === "row");
    const last = rows.reduce((most, f) => Math.max(most, Number(f.properties["name"]) || 0), 0);
    const starts: Point[] = [];
    for (const { geometry, properties } of rows) {
      if (geometry.type !== "LineString") continue;
      const line = projection.line(geometry.coordinates);
      const number = Number(properties["name"]);
      const [first, final] = [line[0]!, line.at(-1)!];
      starts.push(first);
      for (const [end, other] of [[first, final], [final, first]] as [Point, Point][]) {
        const length = distance(end, other) || 1;
        this.names.push({
          text: String(properties["name"]),
          at: end,
          size: 11,
          worth: 4 + (Number.isInteger(number) ? worth(number, last) : 5),
          number,
          out: [(end[0] - other[0]) / length, (end[1] - other[1]) / length],
        });
      }
    }
    const gaps = starts.slice(1).map((p, k) => distance(p, starts[k]!)).sort((a, b) => a - b);
    this.rowsApart = gaps[Math.floor(gaps.length / 4)] ?? Infinity;
  }

  private plantRadius(): number {
    const [west, south, east, north] = boxOf(this.plants);
    const spacing = Math.sqrt(((east - west + 5) * (north - south + 5)) / Math.max(this.plants.length, 1));
    return Math.min(Math.max(spacing * 0.24, 0.3), 3);
  }

  private paintZones(view: View): void {
    const { context } = view;
    for (const { rings, kind } of this.zones) {
      context.beginPath();
      for (const ring of rings) trace(view, ring, true);
      if (kind === "keep_out" || kind === "avoided") {
        context.fillStyle = view.colour(kind === "keep_out" ? "water" : "bad-soft");
        context.fill("evenodd");
      }
      context.setLineDash(kind === "boundary" ? [9, 5] : kind === "keep_out" ? [] : [3, 4]);
      context.lineWidth = 1.75;
      context.strokeStyle = view.colour(kind === "keep_out" ? "water-line" : kind === "avoided" ? "bad" : "quiet");
      context.stroke();
    }
    context.setLineDash([]);
    context.lineWidth = 1;
    context.strokeStyle = view.colour("quiet");
    for (const block of this.blocks) {
      context.beginPath();
      trace(view, block, true);
      context.stroke();
    }
  }

  private paintRows(view: View): void {
    const { context } = view;
    context.globalAlpha = 0.45;
    context.strokeStyle = view.colour("tree");
    context.lineWidth = 1.25;
    for (const inferred of [false, true]) {
      context.setLineDash(inferred ? [5, 3] : []);
      context.beginPath();
      for (const row of this.rows) if (row.inferred === inferred) trace(view, row.line);
      context.stroke();
    }
    context.setLineDash([]);
    context.globalAlpha = 1;
  }

  private paintPlants(view: View): void {
    const { context, width, height } = view;
    const radius = this.radius * view.perMetre;
    context.fillStyle = view.colour("tree");
    if (radius < 1.6) {
      // A square of this size cannot be told from a disc, and takes a tenth of the time.
      const side = Math.max(2 * radius, 1);
      for (const plant of this.plants) {
        const [x, y] = view.at(plant);
        if (x > -side && y > -side && x < width + side && y < height + side) context.fillRect(x - side / 2, y - side / 2, side, side);
      }
      return;
    }
    context.beginPath();
    for (const plant of this.plants) {
      const [x, y] = view.at(plant);
      if (x < -radius || y < -radius || x > width + radius || y > height + radius) continue;
      context.moveTo(x + radius, y);
      context.arc(x, y, radius, 0, 2 * Math.PI);
    }
    context.fill();
  }

  private paintSigns(view: View): Rectangle[] {
    const { context } = view;
    const taken: Rectangle[] = [];
    const box = ([x, y]: Point) => taken.push([x - 11, y - 11, x + 11, y + 11]);
    for (const gate of this.gates) {
      const [x, y] = view.at(gate.at);
      box([x, y]);
      context.lineWidth = 2;
      context.strokeStyle = view.colour("ink");
      context.fillStyle = view.colour("card");
      context.fillRect(x - 5, y - 5, 10, 10);
      context.strokeRect(x - 5, y - 5, 10, 10);
    }
    for (const marker of this.markers) {
      const [x, y] = view.at(marker.at);
      box([x, y]);
      context.fillStyle = view.colour("ink");
      context.beginPath();
      context.roundRect(x - 10, y - 10, 20, 20, 4);
      context.fill();
      label(view, marker.text, [x, y + 0.5], { size: 12, fill: "card", halo: "" });
    }
    return taken;
  }

  private paintNames(view: View, taken: Rectangle[]): void {
    const { context } = view;
    const step = ROW_STEPS.find((one) => one * this.rowsApart * view.perMetre >= ROW_PX) ?? ROW_STEPS.at(-1)!;
    const names = this.names.filter(({ number }) => !(number !== undefined && number > 1 && number % step));
    const wanted = names.map((name): Wanted => {
      context.font = `600 ${name.size}px ${LETTERS}`;
      const width = context.measureText(name.text).width + 4;
      return { width, height: name.size * 1.2, spots: spots(name, view, width) };
    });
    placed(wanted, [0, 0, view.width, view.height], taken).forEach((spot, k) => {
      const name = names[k]!;
      if (spot) label(view, name.text, spot, { size: name.size, fill: name.bold ? "ink" : "quiet" });
    });
  }
}

// Where the middle of a name may be, the best first.
function spots({ at, out, beside, size }: Name, view: View, width: number): Point[] {
  const [x, y] = view.at(at);
  const height = size * 1.2;
  if (out) {
    const half = (Math.abs(out[0]) * width + Math.abs(out[1]) * height) / 2;
    return [5, 12].map((gap) => [x + out[0] * (gap + half), y - out[1] * (gap + half)]);
  }
  if (beside) return [[x, y + 19], [x, y - 19], [x + width / 2 + 12, y], [x - width / 2 - 12, y]];
  return [[x, y]];
}

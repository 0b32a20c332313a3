// A plan: its drive with arrows, its numbered stops, or the places of a question's choices.

import type { Feature } from "../lib/types";
import { CanvasLayer, label, trace, type View } from "./canvas_layer";
import { distance, type Point, type Projection } from "./geometry";
import { placed, worth, type Wanted } from "./names";

export interface Stop {
  at: Point;
  number: number;
  place: string;
  kind: string;
  nodes: string[];
  branch: boolean;
}

export interface Choice {
  at: Point;
  numbers: number[];
  labelled: boolean;
  place: string;
  kind: string;
}

interface Path {
  line: Point[];
  kind: "path" | "home" | "branch" | "work";
}

const ARROW_PX = 90; // from arrow to arrow
const STOP_PX = 26;
const CHOICE_COLOURS = 4;

// Choices are told apart by four colours, which come round again; the numbers say the rest.
export const choiceColour = (number: number): string => `choice-${((number - 1) % CHOICE_COLOURS) + 1}`;

export class PlanLayer extends CanvasLayer {
  stops: Stop[] = [];
  choices: Choice[] = [];
  private paths: Path[] = [];
  private lit = new Set<string>(); // nodes
  private litChoice = 0;
  private faint = false;

  constructor() {
    super("plan");
  }

  show(features: Feature[], projection: Projection): void {
    this.clear();
    for (const { geometry, properties } of features) {
      if (geometry.type === "LineString" && (properties.role === "path" || properties.role === "work")) {
        const kind = properties.role === "work" ? "work" : properties["branch"] ? "branch" : properties["home"] ? "home" : "path";
        this.paths.push({ line: projection.line(geometry.coordinates), kind });
      }
      if (geometry.type !== "Point") continue;
      const at = projection.metres(geometry.coordinates);
      if (properties.role === "stop") this.stops.push({ ...(properties as unknown as Stop), at });
      if (properties.role === "choice") this.choices.push({ ...(properties as unknown as Choice), at });
    }
    this.redraw();
  }

  clear(): void {
    this.paths = [];
    this.stops = [];
    this.choices = [];
    this.lit.clear();
    this.litChoice = 0;
    this.faint = false;
    this.redraw();
  }

  // Behind a drive that was driven.
  setFaint(faint: boolean): void {
    this.faint = faint;
    this.redraw();
  }

  light(nodes: string[]): void {
    this.lit = new Set(nodes);
    this.redraw();
  }

  lightChoice(number: number): void {
    this.litChoice = number;
    this.redraw();
  }

  stopsOf(nodes: string[]): Stop[] {
    return this.stops.filter((stop) => stop.nodes.some((node) => nodes.includes(node)));
  }

  // The choice nearest to a point, within a distance in metres.
  choiceAt(point: Point, within: number): Choice | null {
    return nearest(this.choices, point, within);
  }

  stopAt(point: Point, within: number): Stop | null {
    return nearest(this.stops, point, within);
  }

  protected paint(view: View): void {
    view.context.globalAlpha = this.faint ? 0.4 : 1;
    for (const path of this.paths) paintPath(view, path);
    this.paintStops(view);
    this.paintChoices(view);
    view.context.globalAlpha = 1;
  }

  // Numbers that would cover each other give way to dots until the map is zoomed in: the ends and round ones stay.
  private paintStops(view: View): void {
    const last = this.stops.length;
    const byWorth = [...this.stops].sort((a, b) => worth(a.number, last) - worth(b.number, last) || a.number - b.number);
    const wanted = byWorth.map((stop): Wanted => ({ width: STOP_PX, height: STOP_PX, spots: [view.at(stop.at)] }));
    const room = placed(wanted, [-Infinity, -Infinity, Infinity, Infinity]);
    const numbered = byWorth.filter((_, k) => room[k]);
    const crowd = byWorth.filter((_, k) => !room[k]);
    for (const stop of crowd) paintStop(view, stop, 5, this.isLit(stop), false);
    for (const stop of numbered.reverse()) paintStop(view, stop, String(stop.number).length > 2 ? 14 : 12, this.isLit(stop), true);
    // What is pointed at lies above all.
    for (const stop of this.stops) if (this.isLit(stop)) paintStop(view, stop, 13, true, room[byWorth.indexOf(stop)] !== null);
  }

  private isLit(stop: Stop): boolean {
    return stop.nodes.some((node) => this.lit.has(node));
  }

  private paintChoices(view: View): void {
    const { context } = view;
    const shown = [...this.choices].sort((a, b) => Number(a.labelled) - Number(b.labelled));
    for (const { at, numbers, labelled } of shown) {
      const [x, y] = view.at(at);
      const lit = numbers.includes(this.litChoice);
      const text = [...numbers].sort((a, b) => a - b).join(", ");
      context.beginPath();
      context.arc(x, y, labelled ? 10 + 1.7 * text.length : lit ? 8 : 6, 0, 2 * Math.PI);
      context.fillStyle = view.colour(choiceColour(numbers[0] ?? 1));
      context.fill();
      context.lineWidth = lit ? 4 : 2;
      context.strokeStyle = view.colour(lit ? "ink" : "card");
      context.stroke();
      if (labelled) label(view, text, [x, y + 0.5], { size: 12, fill: "on-choice", halo: "" });
    }
  }
}

function nearest<T extends { at: Point }>(signs: T[], point: Point, within: number): T | null {
  let [best, least]: [T | null, number] = [null, within];
  for (const sign of signs) {
    const away = distance(sign.at, point);
    if (away < least) [best, least] = [sign, away];
  }
  return best;
}

function paintStop(view: View, stop: Stop, radius: number, lit: boolean, numbered: boolean): void {
  const { context } = view;
  const [x, y] = view.at(stop.at);
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = view.colour(stop.branch ? "card" : "stop");
  context.fill();
  context.lineWidth = lit ? 4 : 2;
  context.setLineDash(stop.branch && !lit ? [3, 2] : []);
  context.strokeStyle = view.colour(lit ? "ink" : stop.branch ? "stop" : "card");
  context.stroke();
  context.setLineDash([]);
  if (numbered) label(view, String(stop.number), [x, y + 0.5], { size: 12, fill: stop.branch ? "stop" : "on-stop", halo: "" });
}

const WIDTHS: Record<Path["kind"], number> = { path: 3, home: 2, branch: 2, work: 7 };

function paintPath(view: View, { line, kind }: Path): void {
  const { context } = view;
  context.beginPath();
  trace(view, line);
  context.lineJoin = context.lineCap = "round";
  context.lineWidth = WIDTHS[kind];
  context.setLineDash(kind === "branch" ? [3, 6] : []);
  context.strokeStyle = view.colour(kind === "work" ? "work" : "stop");
  context.stroke();
  context.setLineDash([]);
  if (kind !== "work") arrows(view, line);
}

// Heads of arrows along a line, so far from each other that they can be told apart.
function arrows(view: View, line: Point[]): void {
  const { context } = view;
  context.fillStyle = view.colour("stop");
  let left = ARROW_PX / 2;
  for (let k = 1; k < line.length; k++) {
    const [a, b] = [view.at(line[k - 1]!), view.at(line[k]!)];
    const length = distance(a, b);
    const [dx, dy] = [(b[0] - a[0]) / (length || 1), (b[1] - a[1]) / (length || 1)];
    while (left <= length) {
      const [x, y] = [a[0] + dx * left, a[1] + dy * left];
      context.beginPath();
      context.moveTo(x + 7 * dx, y + 7 * dy);
      context.lineTo(x - 4 * dx - 5.5 * dy, y - 4 * dy + 5.5 * dx);
      context.lineTo(x - 4 * dx + 5.5 * dy, y - 4 * dy - 5.5 * dx);
      context.closePath();
      context.fill();
      left += ARROW_PX;
    }
    left -= length;
  }
}

// A mission that is driven: its track, its captures by status or by a reading, and the robot.

import { CanvasLayer, trace, type View } from "./canvas_layer";
import type { Point } from "./geometry";
import type { Scale } from "./scale";

export interface Capture {
  at: Point;
  t: number;
  status: string;
  action: string;
  place: string;
  readings: Record<string, number>;
  units: Record<string, string>;
}

export interface Robot {
  at: Point;
  heading: number | null; // radians anticlockwise from east
  stale: boolean;
}

export class DriveLayer extends CanvasLayer {
  captures: Capture[] = [];
  private track: Point[] = [];
  private robot: Robot | null = null;
  private quantity = "";
  private scale: Scale | null = null;

  constructor() {
    super("drive");
  }

  clear(): void {
    this.captures = [];
    this.track = [];
    this.robot = null;
    this.redraw();
  }

  setTrack(track: Point[], robot: Robot | null): void {
    this.track = track;
    this.robot = robot;
    this.redraw();
  }

  setCaptures(captures: Capture[]): void {
    this.captures = captures;
    this.redraw();
  }

  // Colours captures by a reading; by their status without one.
  colourBy(quantity: string, scale: Scale | null): void {
    this.quantity = quantity;
    this.scale = scale;
    this.redraw();
  }

  captureAt(point: Point, within: number): Capture | null {
    let [best, least]: [Capture | null, number] = [null, within];
    for (const capture of this.captures) {
      const away = Math.hypot(capture.at[0] - point[0], capture.at[1] - point[1]);
      if (away <= least) [best, least] = [capture, away];
    }
    return best;
  }

  protected paint(view: View): void {
    const { context } = view;
    context.lineJoin = context.lineCap = "round";
    context.beginPath();
    trace(view, this.track);
    context.lineWidth = 4;
    context.strokeStyle = view.colour("drive");
    context.stroke();
    for (const capture of this.captures) this.paintCapture(view, capture);
    if (this.robot) paintRobot(view, this.robot);
  }

  private paintCapture(view: View, { at, status, readings }: Capture): void {
    const { context } = view;
    const [x, y] = view.at(at);
    const value = readings[this.quantity];
    const known = this.scale !== null && value !== undefined;
    context.beginPath();
    context.arc(x, y, known ? 9 : 6, 0, 2 * Math.PI);
    context.fillStyle = known ? this.scale!.colour(value) : view.colour(status === "success" ? "good" : "bad");
    context.fill();
    context.lineWidth = 2;
    context.strokeStyle = view.colour(known ? "ink" : "card");
    context.stroke();
    if (status !== "success") cross(view, [x, y]);
  }
}

function cross(view: View, [x, y]: Point): void {
  const { context } = view;
  context.beginPath();
  context.moveTo(x - 3, y - 3);
  context.lineTo(x + 3, y + 3);
  context.moveTo(x + 3, y - 3);
  context.lineTo(x - 3, y + 3);
  context.lineWidth = 2;
  context.strokeStyle = view.colour("card");
  context.stroke();
}

function paintRobot(view: View, { at, heading, stale }: Robot): void {
  const { context } = view;
  const [x, y] = view.at(at);
  context.save();
  context.translate(x, y);
  context.beginPath();
  context.arc(0, 0, 12, 0, 2 * Math.PI);
  context.fillStyle = view.colour(stale ? "card" : "drive");
  context.fill();
  context.lineWidth = 3;
  context.setLineDash(stale ? [4, 3] : []);
  context.strokeStyle = view.colour(stale ? "quiet" : "card");
  context.stroke();
  if (heading !== null) {
    context.rotate(-heading);
    context.beginPath();
    context.moveTo(8, 0);
    context.lineTo(-5, -5.5);
    context.lineTo(-2, 0);
    context.lineTo(-5, 5.5);
    context.closePath();
    context.fillStyle = view.colour(stale ? "quiet" : "card");
    context.fill();
  }
  context.restore();
}

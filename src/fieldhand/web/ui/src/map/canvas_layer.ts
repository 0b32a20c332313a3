// A layer of the map on a canvas of its own, drawn anew whenever the view or its content changes.

import L from "leaflet";

import type { Point } from "./geometry";

// What a layer draws with: from metres to pixels of the canvas, and the colours of the page.
export interface View {
  context: CanvasRenderingContext2D;
  width: number;
  height: number;
  perMetre: number;
  at(point: Point): Point;
  colour(name: string): string;
}

export abstract class CanvasLayer extends L.Layer {
  protected canvas = document.createElement("canvas");
  private pending = 0;
  private styles: CSSStyleDeclaration | null = null;
  private readonly colours = new Map<string, string>();
  private readonly scheme = matchMedia("(prefers-color-scheme: dark)");

  constructor(private readonly name: string) {
    super();
  }

  override onAdd(map: L.Map): this {
    this.canvas.className = `map-canvas ${this.name}`;
    map.getPanes().overlayPane.append(this.canvas);
    map.on("move zoom viewreset resize", this.redraw, this);
    this.scheme.addEventListener("change", this.recolour);
    this.redraw();
    return this;
  }

  override onRemove(map: L.Map): this {
    map.off("move zoom viewreset resize", this.redraw, this);
    this.scheme.removeEventListener("change", this.recolour);
    this.canvas.remove();
    return this;
  }

  // Once a frame, however many ask for it.
  redraw(): void {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.draw();
    });
  }

  protected abstract paint(view: View): void;

  readonly recolour = (): void => {
    this.colours.clear();
    this.redraw();
  };

  private draw(): void {
    const map = this._map;
    const context = this.canvas.getContext("2d");
    if (!map || !context) return;
    const { x: width, y: height } = map.getSize();
    if (!width || !height) return;
    const dots = Math.min(devicePixelRatio || 1, 2);
    if (this.canvas.width !== Math.round(width * dots) || this.canvas.height !== Math.round(height * dots)) {
      this.canvas.width = Math.round(width * dots);
      this.canvas.height = Math.round(height * dots);
      this.canvas.style.width = `${width}px`;
      this.canvas.style.height = `${height}px`;
    }
    L.DomUtil.setPosition(this.canvas, map.containerPointToLayerPoint([0, 0]));
    context.setTransform(dots, 0, 0, dots, 0, 0);
    context.clearRect(0, 0, width, height);
    this.styles = getComputedStyle(document.documentElement);
    const perMetre = 2 ** map.getZoom();
    const zero = map.latLngToContainerPoint([0, 0]);
    this.paint({
      context,
      width,
      height,
      perMetre,
      at: ([x, y]) => [zero.x + x * perMetre, zero.y - y * perMetre],
      colour: (name) => this.colour(name),
    });
  }

  private colour(name: string): string {
    let value = this.colours.get(name);
    if (value === undefined) {
      value = this.styles?.getPropertyValue(`--${name}`).trim() || "#000";
      this.colours.set(name, value);
    }
    return value;
  }
}

export function trace(view: View, line: Point[], closed = false): void {
  const { context } = view;
  line.forEach((point, k) => {
    const [x, y] = view.at(point);
    if (k) context.lineTo(x, y);
    else context.moveTo(x, y);
  });
  if (closed) context.closePath();
}

export const LETTERS = 'system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';

export function label(view: View, text: string, [x, y]: Point, { size = 12, fill = "ink", halo = "field" } = {}): void {
  const { context } = view;
  context.font = `600 ${size}px ${LETTERS}`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.lineJoin = "round";
  context.lineWidth = 3;
  if (halo) {
    context.strokeStyle = view.colour(halo);
    context.strokeText(text, x, y);
  }
  context.fillStyle = view.colour(fill);
  context.fillText(text, x, y);
}

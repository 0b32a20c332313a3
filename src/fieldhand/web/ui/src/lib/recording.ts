// The drive of a mission from its events: legs, captures, and where it ended, as features of a map.

import type { Feature, LogEvent, Position } from "./types";

const position = (lat: unknown, lon: unknown): Position => [Number(lon), Number(lat)];

export class Recording {
  readonly events: LogEvent[] = [];
  readonly told: string[] = [];
  readonly features: Feature[] = [];
  private driving: LogEvent | null = null;

  add(event: LogEvent, told: string): void {
    this.events.push(event);
    this.told.push(told);
    if (event.event === "drive") this.driving = event;
    if (event.event === "arrive") this.leg(event);
    if (event.event === "action")
      this.features.push({ type: "Feature", geometry: { type: "Point", coordinates: position(event["lat"], event["lon"]) }, properties: { ...event, role: "capture" } });
    if (event.event === "mission") {
      // A drive that was cut short ends where the robot is.
      this.leg(event);
      this.features.push({ type: "Feature", geometry: { type: "Point", coordinates: position(event["lat"], event["lon"]) }, properties: { role: "end", t: event.t } });
    }
  }

  // The path of the drive under way; empty while the robot stands.
  path(): Position[] {
    return this.driving ? (this.driving["path"] as [number, number][]).map(([lat, lon]) => position(lat, lon)) : [];
  }

  private leg(arrived: LogEvent): void {
    if (!this.driving) return;
    const path = this.path();
    const at = position(arrived["lat"], arrived["lon"]);
    const line = arrived.event === "arrive" ? path : [...until(path, at), at];
    this.features.push({
      type: "Feature",
      geometry: { type: "LineString", coordinates: line },
      properties: { role: "leg", node: this.driving["node"], t: this.driving.t, until: arrived.t, to: this.driving["place"] },
    });
    this.driving = null;
  }
}

// The points of a path before the one next to a position.
export function until(path: Position[], at: Position): Position[] {
  let [best, least] = [0, Infinity];
  const scale = Math.cos((at[1] * Math.PI) / 180);
  for (let k = 1; k < path.length; k++) {
    const [a, b] = [path[k - 1]!, path[k]!];
    const [dx, dy] = [(b[0] - a[0]) * scale, b[1] - a[1]];
    const [px, py] = [(at[0] - a[0]) * scale, at[1] - a[1]];
    const share = Math.min(Math.max((px * dx + py * dy) / (dx * dx + dy * dy || 1), 0), 1);
    const off = Math.hypot(px - share * dx, py - share * dy);
    if (off < least) [best, least] = [k, off];
  }
  return path.slice(0, Math.max(best, 1));
}

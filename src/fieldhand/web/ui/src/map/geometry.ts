// Points of a site in metres east and north of its middle.

import type { Feature, Position } from "../lib/types";

export type Point = [number, number];
export type Box = [number, number, number, number]; // west, south, east, north

const METRES_PER_DEGREE = 111_320;

export class Projection {
  private constructor(
    private readonly lon: number,
    private readonly lat: number,
  ) {}

  // Around the middle of the features.
  static of(features: Feature[]): Projection {
    const [west, south, east, north] = boxOf(features.flatMap(positions));
    return new Projection((west + east) / 2, (south + north) / 2);
  }

  metres([lon, lat]: Position): Point {
    return [(lon - this.lon) * METRES_PER_DEGREE * Math.cos((this.lat * Math.PI) / 180), (lat - this.lat) * METRES_PER_DEGREE];
  }

  line(coordinates: Position[]): Point[] {
    return coordinates.map((p) => this.metres(p));
  }
}

export function positions({ geometry }: Feature): Position[] {
  if (geometry.type === "Point") return [geometry.coordinates];
  return geometry.type === "Polygon" ? geometry.coordinates.flat() : geometry.coordinates;
}

export function boxOf(points: Iterable<Point>): Box {
  let [west, south, east, north] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of points) {
    if (x < west) west = x;
    if (x > east) east = x;
    if (y < south) south = y;
    if (y > north) north = y;
  }
  return west <= east ? [west, south, east, north] : [0, 0, 0, 0];
}

export const middle = (points: Point[]): Point => {
  const [west, south, east, north] = boxOf(points);
  return [(west + east) / 2, (south + north) / 2];
};

export const distance = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1]);

// The points of a line up to a share of its length, and its heading there (radians anticlockwise from east).
export function upTo(line: Point[], share: number): { points: Point[]; heading: number } {
  let left = share * lengthOf(line);
  const points: Point[] = line.length ? [line[0]!] : [];
  let heading = 0;
  for (let k = 1; k < line.length; k++) {
    const [a, b] = [line[k - 1]!, line[k]!];
    const length = distance(a, b);
    if (length > 0) heading = Math.atan2(b[1] - a[1], b[0] - a[0]);
    if (length >= left) {
      const part = length ? left / length : 1;
      points.push([a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part]);
      break;
    }
    points.push(b);
    left -= length;
  }
  return { points, heading };
}

export function lengthOf(line: Point[]): number {
  let length = 0;
  for (let k = 1; k < line.length; k++) length += distance(line[k - 1]!, line[k]!);
  return length;
}

// Names on the map: which of them have room. Sizes and places are in pixels; nothing here draws.

export type Rectangle = [number, number, number, number]; // left, top, right, bottom

export interface Wanted {
  width: number;
  height: number;
  spots: [number, number][]; // where its middle may be, the best first
}

const GAP = 3;

// For each name, in order, the first of its spots where it covers nothing before it and stays in the frame; else null.
export function placed(names: Wanted[], frame: Rectangle, taken: Rectangle[] = []): ([number, number] | null)[] {
  const boxes = [...taken];
  return names.map(({ spots, width, height }) => {
    for (const [x, y] of spots) {
      const box: Rectangle = [x - width / 2, y - height / 2, x + width / 2, y + height / 2];
      const inside = box[0] >= frame[0] && box[1] >= frame[1] && box[2] <= frame[2] && box[3] <= frame[3];
      if (inside && boxes.every((other) => apart(box, other))) {
        boxes.push(box);
        return [x, y];
      }
    }
    return null;
  });
}

// How late a number of a count is written: the ends first, then the roundest.
export function worth(number: number, last: number): number {
  if (number === 1 || number === last) return 0;
  const round = [100, 50, 20, 10, 5, 2].findIndex((step) => number % step === 0);
  return round < 0 ? 7 : round + 1;
}

const apart = (a: Rectangle, b: Rectangle) => a[0] >= b[2] + GAP || a[2] <= b[0] - GAP || a[1] >= b[3] + GAP || a[3] <= b[1] - GAP;

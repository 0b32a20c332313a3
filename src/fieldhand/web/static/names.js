// Names on the map: which of them have room. Sizes and places are in pixels; nothing here touches the page.

const GAP = 3;
const LETTER = 0.62; // of the size of the letters: how wide one is at most

export const widthOf = (text, size) => text.length * size * LETTER + 2;

// For each name, first things first, the first of its spots where it covers nothing before it and stays in the frame; else null.
export function placed(names, frame, taken = []) {
  const boxes = [...taken];
  return names.map(({ spots, width, height }) => {
    for (const [x, y] of spots) {
      const box = [x - width / 2, y - height / 2, x + width / 2, y + height / 2];
      const inside = box[0] >= frame[0] && box[1] >= frame[1] && box[2] <= frame[2] && box[3] <= frame[3];
      if (inside && boxes.every((other) => apart(box, other))) {
        boxes.push(box);
        return [x, y];
      }
    }
    return null;
  });
}

// How much a number of a count matters: the ends, then the roundest; the less the more.
export function worth(number, last) {
  if (number === 1 || number === last) return 0;
  const round = [100, 50, 20, 10, 5, 2].findIndex((step) => number % step === 0);
  return round < 0 ? 7 : round + 1;
}

const apart = (a, b) => a[0] >= b[2] + GAP || a[2] <= b[0] - GAP || a[1] >= b[3] + GAP || a[3] <= b[1] - GAP;

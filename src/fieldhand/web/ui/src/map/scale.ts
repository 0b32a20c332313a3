// Colours for the values of a reading: from dark blue to yellow, growing lighter, so that they can be told apart without hue.

const STOPS: [number, number, number][] = [
  [38, 20, 92],
  [54, 80, 150],
  [32, 137, 141],
  [92, 184, 92],
  [252, 231, 60],
];

export class Scale {
  constructor(
    readonly least: number,
    readonly most: number,
  ) {}

  // From the least to the greatest of some values; null for none.
  static of(values: number[]): Scale | null {
    const finite = values.filter(Number.isFinite);
    if (!finite.length) return null;
    return new Scale(
      finite.reduce((a, b) => Math.min(a, b)),
      finite.reduce((a, b) => Math.max(a, b)),
    );
  }

  colour(value: number): string {
    const span = this.most - this.least;
    const share = span > 0 ? Math.min(Math.max((value - this.least) / span, 0), 1) : 0.5;
    const place = share * (STOPS.length - 1);
    const k = Math.min(Math.floor(place), STOPS.length - 2);
    const [a, b] = [STOPS[k]!, STOPS[k + 1]!];
    return `rgb(${a.map((part, i) => Math.round(part + (b[i]! - part) * (place - k))).join(" ")})`;
  }
}

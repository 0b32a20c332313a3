// Whether the server carries out missions itself.

import { get, Problem } from "../lib/api";

let offered: Promise<boolean> | null = null;

export function missionsOffered(): Promise<boolean> {
  offered ??= get("/missions").then(
    () => true,
    (problem) => {
      if (problem instanceof Problem && problem.status !== 404) offered = null; // asked again next time
      return false;
    },
  );
  return offered;
}

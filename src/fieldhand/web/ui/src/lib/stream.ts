// The page's one stream of events: what it follows changes with what is shown, and a heartbeat says that the server is there.

import { current } from "../lang";
import { get } from "./api";
import type { Heard } from "./types";

type Listener = (message: Heard) => void;

const KINDS = ["mission", "event", "position", "gone", "heartbeat"] as const;
const AGAIN_MS = 1500;

class EventStream {
  heardAt = performance.now();
  private source: EventSource | null = null;
  private readonly listeners = new Set<Listener>();
  private missions: string[] | "all" = [];
  private running = false;

  begin(): void {
    this.running = true;
    this.open();
  }

  listen(listener: Listener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  // Follows these missions from their beginning; "all" are those under way.
  follow(missions: string[] | "all"): void {
    this.missions = missions;
    if (this.running) this.open();
  }

  private open(): void {
    this.source?.close();
    const query = new URLSearchParams({ lang: current() });
    if (this.missions !== "all") query.set("missions", this.missions.join(","));
    const source = (this.source = new EventSource(`/api/v1/stream?${query}`));
    for (const kind of KINDS) {
      source.addEventListener(kind, (event) => {
        this.heardAt = performance.now();
        const data = JSON.parse((event as MessageEvent<string>).data);
        for (const listener of this.listeners) listener({ kind, data } as Heard);
      });
    }
    // The browser connects again by itself, unless the server refused: then it may be the session that has ended.
    source.addEventListener("error", () => {
      if (source.readyState !== EventSource.CLOSED || source !== this.source) return;
      void get("/session").catch(() => undefined);
      setTimeout(() => source === this.source && this.open(), AGAIN_MS);
    });
  }
}

export const stream = new EventStream();

// Notices within three seconds that the server cannot be reached, and that it is back: by the heartbeat of the stream, or by
// asking, where the server has no stream.

import { stream } from "./stream";

const LOOK_MS = 500;
const SILENT_MS = 2400; // heartbeats come every second
const PATIENCE_MS = 1900;

type Listener = (connected: boolean) => void;

class Connection {
  connected = true;
  private readonly listeners: Listener[] = [];

  watch(listener: Listener): void {
    this.listeners.push(listener);
  }

  begin(streaming: boolean): void {
    addEventListener("offline", () => this.set(false));
    if (streaming) {
      stream.begin();
      stream.listen(() => this.set(true));
      setInterval(() => !document.hidden && performance.now() - stream.heardAt > SILENT_MS && this.set(false), LOOK_MS);
      return;
    }
    const ask = async () => {
      if (!document.hidden) this.set(await answers());
      setTimeout(ask, 2 * LOOK_MS);
    };
    void ask();
  }

  private set(connected: boolean): void {
    if (connected === this.connected) return;
    this.connected = connected;
    for (const listener of this.listeners) listener(connected);
  }
}

async function answers(): Promise<boolean> {
  try {
    await fetch("/", { method: "HEAD", cache: "no-store", signal: AbortSignal.timeout(PATIENCE_MS) });
    return true;
  } catch {
    return false;
  }
}

export const connection = new Connection();

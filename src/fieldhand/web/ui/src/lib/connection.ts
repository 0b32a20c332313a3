// Notices within three seconds that the server cannot be reached, and that it is back.

const EVERY_MS = 1000;
const PATIENCE_MS = 1900;

type Listener = (connected: boolean) => void;

export class Connection {
  connected = true;
  private readonly listeners: Listener[] = [];

  watch(listener: Listener): void {
    this.listeners.push(listener);
  }

  begin(): void {
    const look = async () => {
      if (!document.hidden) this.set(await answers());
      setTimeout(look, EVERY_MS);
    };
    setTimeout(look, EVERY_MS);
    addEventListener("offline", () => this.set(false));
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

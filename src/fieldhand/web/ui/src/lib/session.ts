// Who uses the page, and what that person may do. A server without accounts lets everybody do everything.

import { use } from "../lang";
import { access, call, get, post, Problem, remove } from "./api";
import { remembered } from "./kept";

export type Scope = "read" | "plan" | "approve" | "command" | "admin";

interface Opened {
  name: string;
  local?: boolean; // the administrator of the server's own machine, who has no account
  language: string;
  scopes: Scope[];
  csrf: string;
}

export type State = "open" | "in" | "out" | "unknown"; // no accounts; logged in; to be logged in; the server does not answer

class Session {
  state: State = "open";
  name = "";
  local = true;
  private scopes: Scope[] | null = null;

  may(scope: Scope): boolean {
    return this.scopes === null || this.scopes.includes(scope);
  }

  // Finds out whether the server has accounts and who this is; a link with a code logs in.
  async begin(): Promise<void> {
    const code = /^#code=(.+)$/.exec(location.hash)?.[1];
    try {
      if (code) {
        history.replaceState(null, "", "#/ask");
        await post("/session/code", { code: decodeURIComponent(code) });
      }
      this.take(await get<Opened>("/session"));
    } catch (problem) {
      if (!(problem instanceof Problem)) throw problem;
      if (problem.status === 404) this.state = "open";
      else this.state = problem.status === 401 || problem.status === 403 ? "out" : "unknown";
    }
  }

  async enter(name: string, password: string): Promise<void> {
    await post("/session", { name, password });
    this.take(await get<Opened>("/session"));
  }

  async leave(): Promise<void> {
    await remove("/session");
    access.csrf = "";
    this.state = "out";
  }

  // Keeps the language with the account, for messages of the server.
  async speak(language: string): Promise<void> {
    if (this.state === "in") await call("PATCH", "/session", { language }).catch(() => undefined);
  }

  private take({ name, local, language, scopes, csrf }: Opened): void {
    this.state = "in";
    access.base = "/api/v1";
    this.name = name;
    this.local = local ?? false;
    // The choice on this device comes first, then that of the account; who has none keeps the browser's.
    if (!this.local && remembered<string | null>("language", null) === null) use(language);
    this.scopes = scopes;
    access.csrf = csrf;
  }
}

export const session = new Session();

// Who uses the page, and what that person may do. A server without accounts lets everybody do everything.

import { access, get, post, Problem, remove } from "./api";

export type Scope = "read" | "plan" | "approve" | "command" | "admin";

interface Opened {
  name: string;
  role: string;
  scopes: Scope[];
  csrf: string;
}

export type State = "open" | "in" | "out"; // no accounts; logged in; to be logged in

class Session {
  state: State = "open";
  name = "";
  role = "";
  private scopes: Scope[] | null = null;

  may(scope: Scope): boolean {
    return this.scopes === null || this.scopes.includes(scope);
  }

  // Finds out whether the server has accounts and who this is; a link with a code logs in.
  async begin(): Promise<void> {
    const code = /^#code=(.+)$/.exec(location.hash)?.[1];
    access.base = "/api/v1";
    try {
      if (code) {
        history.replaceState(null, "", "#/ask");
        await post("/session/code", { code: decodeURIComponent(code) });
      }
      this.take(await get<Opened>("/session"));
    } catch (problem) {
      if (!(problem instanceof Problem)) throw problem;
      if (problem.status === 404) access.base = "/api";
      else if (problem.status === 401 || problem.status === 403) this.state = "out";
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

  private take({ name, role, scopes, csrf }: Opened): void {
    this.state = "in";
    this.name = name;
    this.role = role;
    this.scopes = scopes;
    access.csrf = csrf;
  }
}

export const session = new Session();

// Calls of the REST API. A failure is thrown as a Problem: what is wrong, where, and what to do.

import { current, t } from "../lang";

export class Problem extends Error {
  constructor(
    readonly what: string,
    readonly where = "",
    readonly advice = "",
    readonly status = 0,
    readonly body: Record<string, unknown> = {},
  ) {
    super(what);
  }
}

// Where the API is, and what a request that changes something has to carry with a session's cookie.
export const access = { base: "/api", csrf: "", onend: (): void => {} };

export const get = <T>(path: string, signal?: AbortSignal): Promise<T> => call<T>("GET", path, undefined, signal);

export const post = <T>(path: string, body?: unknown, signal?: AbortSignal): Promise<T> => call<T>("POST", path, body, signal);

export const remove = <T>(path: string): Promise<T> => call<T>("DELETE", path);

// Missions and logins are below /api/v1 on every server that has them.
const address = (path: string): string => (/^\/(missions|session)/.test(path) ? "/api/v1" : access.base) + path;

export async function call<T>(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<T> {
  const headers: Record<string, string> = { "Accept-Language": current() };
  if (body !== undefined) headers["Content-Type"] = "application/json";
  if (method !== "GET" && access.csrf) headers["X-Fieldhand-CSRF"] = access.csrf;
  let response: Response;
  try {
    response = await fetch(address(path), {
      method,
      headers,
      ...(body === undefined ? {} : { body: JSON.stringify(body) }),
      ...(signal ? { signal } : {}),
    });
  } catch (error) {
    if (error instanceof DOMException && error.name === "AbortError") throw error;
    throw new Problem(t("no_answer"), "", t("no_answer_advice"));
  }
  if (response.status === 204) return undefined as T;
  if (response.status === 401 && access.csrf) access.onend();
  const answer = (await response.json().catch(() => null)) as Record<string, unknown> | null;
  if (response.ok && answer !== null) return answer as T;
  if (typeof answer?.["what"] === "string")
    throw new Problem(answer["what"], String(answer["where"] ?? ""), String(answer["advice"] ?? ""), response.status, answer);
  throw new Problem(t("odd_status", { status: response.status }), "", "", response.status);
}

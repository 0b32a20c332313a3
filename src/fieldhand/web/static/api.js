// Calls of the REST API. A failure is thrown as a Problem: what is wrong, where, and what to do.

export class Problem extends Error {
  constructor(what, where = "", advice = "") {
    super(what);
    this.what = what;
    this.where = where;
    this.advice = advice;
  }
}

export const get = (path) => call(path, { method: "GET" });

export const post = (path, body, signal) =>
  call(path, { method: "POST", signal, body: JSON.stringify(body), headers: { "Content-Type": "application/json" } });

async function call(path, options) {
  let response;
  try {
    response = await fetch(path, options);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Problem("the server does not answer", "", "is it still running?");
  }
  const answer = await response.json().catch(() => null);
  if (response.ok && answer !== null) return answer;
  if (answer?.what) throw new Problem(answer.what, answer.where, answer.advice);
  throw new Problem(`the server answered with status ${response.status}`);
}

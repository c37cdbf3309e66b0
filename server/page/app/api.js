// Requests to the service. A key, when one is needed, lasts as long as the tab.

const KEY = "slewplan-key";

/** What went wrong with a request, in the words of the service. */
export class Problem extends Error {
  constructor(status, document) {
    super(document.detail || document.title || `the service answered ${status}`);
    this.status = status;
    this.code = document.code;
    this.title = document.title;
    this.errors = document.errors ?? [];
    this.warnings = document.warnings ?? [];
  }
}

export const key = {
  get: () => sessionStorage.getItem(KEY) ?? "",
  set: (text) => (text ? sessionStorage.setItem(KEY, text) : sessionStorage.removeItem(KEY)),
};

let askForKey = async () => false;

/** Says how to ask for a key; the answer tells whether one was given. */
export function onKeyNeeded(ask) {
  askForKey = ask;
}

/** A request; asks for a key and tries again when the service wants one. */
export async function request(path, options = {}) {
  for (;;) {
    const headers = { ...options.headers };
    const sent = key.get();
    if (sent) headers.Authorization = `Bearer ${sent}`;
    const answer = await fetch(path, { ...options, headers }).catch((error) => {
      if (error.name === "AbortError") throw error;
      throw new Problem(0, { title: "The service cannot be reached", detail: "The service cannot be reached." });
    });
    if (answer.ok) return answer;
    const problem = new Problem(answer.status, await answer.json().catch(() => ({})));
    if (answer.status !== 401) throw problem;
    const other = key.get() !== sent;
    if (!other && !(await askForKey(Boolean(sent)))) throw problem;
  }
}

/** The document at a path. */
export async function read(path, signal) {
  return (await request(path, { signal })).json();
}

/** Posts a document, or nothing; the answer as it came. */
export async function postForText(path, document, signal) {
  const body = document === undefined ? undefined : typeof document === "string" ? document : JSON.stringify(document);
  const headers = body === undefined ? {} : { "Content-Type": "application/json" };
  return (await request(path, { method: "POST", headers, body, signal })).text();
}

/** Posts a document, or nothing. */
export async function post(path, document, signal) {
  return JSON.parse(await postForText(path, document, signal));
}

/** Deletes what is at a path. */
export async function remove(path) {
  await request(path, { method: "DELETE" });
}

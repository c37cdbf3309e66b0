// Server-sent events by fetch, because EventSource cannot send a key.

import { Problem, request } from "./api.js";

const AGAIN_MS = 2000;

/** Calls back for every event of a job until its stream ends; resumes when the connection breaks. */
export async function follow(id, onEvent, signal) {
  let last = null;
  while (!signal.aborted) {
    try {
      const headers = last === null ? {} : { "Last-Event-ID": last };
      const answer = await request(`/v1/plans/${id}/events`, { headers, signal });
      // The job has ended, and there is nothing after what is known.
      if (answer.status === 204) return;
      let closing = false;
      for await (const event of events(answer.body)) {
        if (event.id) last = event.id;
        if (event.event === "closing") closing = true;
        else onEvent(JSON.parse(event.data));
      }
      if (!closing) return;
    } catch (error) {
      if (signal.aborted) return;
      if (error instanceof Problem && error.status >= 400 && error.status < 500) throw error;
    }
    await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
  }
}

async function* events(body) {
  const reader = body.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return;
    text += value.replaceAll("\r\n", "\n");
    const frames = text.split("\n\n");
    text = frames.pop();
    for (const frame of frames) {
      const event = parse(frame);
      if (event) yield event;
    }
  }
}

/** The fields of an event; null for a comment, which keeps the connection alive. */
function parse(frame) {
  const event = { id: "", event: "message", data: "" };
  let known = false;
  for (const line of frame.split("\n")) {
    const [, name, value] = /^(id|event|data): ?(.*)$/.exec(line) ?? [];
    if (!name) continue;
    known = true;
    event[name] = name === "data" && event.data ? `${event.data}\n${value}` : value;
  }
  return known ? event : null;
}

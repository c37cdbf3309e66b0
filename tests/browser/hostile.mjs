// What pages from elsewhere can do to a service without keys: nothing.

import { createServer } from "node:http";
import { check, eventually, fixture, openBrowser, planned, startService } from "./harness.mjs";

/** A name that its owner points at this machine. */
const NAME = "evil.example";
/** The browser neither asks the network for the name, nor keeps pages from this machine by itself: not all do. */
const OPTIONS = [`--host-resolver-rules=MAP ${NAME} 127.0.0.1`, "--disable-features=LocalNetworkAccessChecks"];
const PAGE = "<!doctype html><title>elsewhere</title><body><p>elsewhere</p></body>";

export async function hostile({ must }) {
  const service = await startService();
  const site = await startSite();
  const browser = await openBrowser(OPTIONS);
  try {
    const scenario = fixture("two-targets");
    const target = { address: service.address, scenario: JSON.stringify(scenario), plan: await planned(service, scenario) };
    for (const host of ["127.0.0.1", "localhost", NAME]) {
      await must(`a page of http://${host} at another port reads and changes nothing`, () =>
        unharmed(service, () => fromElsewhere(browser, `http://${host}:${site.port}/`, target)));
    }
    await must(`a page of ${NAME}, which now leads to the service, reads and changes nothing`, () =>
      unharmed(service, () => rebound(browser, target)));
    await must("a link from elsewhere leads to the page, which works", () =>
      followed(browser, `http://${NAME}:${site.port}/`, target));
  } finally {
    await browser.close();
    await service.stop();
    site.close();
  }
}

/** A server of another page on this machine. */
async function startSite() {
  const server = createServer((_, answer) => answer.setHeader("Content-Type", "text/html").end(PAGE));
  await new Promise((resolve) => { server.listen(0, "127.0.0.1", resolve); });
  const close = () => {
    server.closeAllConnections();
    server.close();
  };
  return { port: server.address().port, close };
}

/** What an attack must leave as it was, and how many requests have been refused. */
async function state(service) {
  const plans = await (await fetch(`${service.address}/v1/plans`)).text();
  const metrics = await (await fetch(`${service.address}/metrics`)).text();
  const refusals = metrics.matchAll(/^slewplan_http_request_duration_seconds_count\{.*status="403".*\} (\d+)$/gm);
  return { plans, refused: [...refusals].reduce((sum, [, count]) => sum + Number(count), 0) };
}

/** Runs an attack, which gives the number of its requests; all of them must come and be refused. */
async function unharmed(service, attack) {
  const before = await state(service);
  const sent = await attack();
  return eventually(async () => {
    const after = await state(service);
    check(after.plans === before.plans, `the plans are others: ${after.plans}`);
    const refused = after.refused - before.refused;
    check(refused >= sent, `${refused} of ${sent} requests came and were refused`);
    return `${refused} requests refused`;
  });
}

/** Runs in a page: sends what a page can send, and tells what it can see of the answers. */
async function tried({ address, scenario, plan }) {
  const seen = {};
  const post = (type, more = {}) => ({ method: "POST", body: new Blob([scenario], { type }), ...more });
  const requests = {
    "GET": ["/v1/plans"],
    "GET without CORS": ["/v1/plans", { mode: "no-cors" }],
    "GET of a plan": [`/v1/plans/${plan}/result`],
    "GET of the page": ["/"],
    "GET of the health": ["/health/ready"],
    "POST of JSON": ["/v1/plans", post("application/json")],
    "POST of text": ["/v1/plans", post("text/plain")],
    "POST of JSON without CORS": ["/v1/plans", post("application/json", { mode: "no-cors" })],
    "POST of text without CORS": ["/v1/plans", post("text/plain", { mode: "no-cors" })],
    "POST of nothing": [`/v1/plans/${plan}/cancel`, { method: "POST", mode: "no-cors" }],
    "DELETE": [`/v1/plans/${plan}`, { method: "DELETE" }],
  };
  for (const [name, [path, options]] of Object.entries(requests)) {
    try {
      const answer = await fetch(address + path, options);
      seen[name] = `${answer.type} ${answer.status} ${await answer.text()}`;
    } catch {
      seen[name] = "nothing";
    }
  }
  const loaded = (name, element, attribute, path) => new Promise((resolve) => {
    element.onload = () => { seen[name] = "loaded"; resolve(); };
    element.onerror = () => { seen[name] = "nothing"; resolve(); };
    element[attribute] = address + path;
    document.body.append(element);
  });
  await loaded("script", document.createElement("script"), "src", "/v1/plans");
  await loaded("image", new Image(), "src", "/v1/plans");
  await loaded("style", Object.assign(document.createElement("link"), { rel: "stylesheet" }), "href", "/v1/plans");
  await new Promise((resolve) => {
    const events = new EventSource(`${address}/v1/plans/${plan}/events`);
    seen.events = "nothing";
    events.onopen = () => { seen.events = "opened"; };
    events.onerror = () => { events.close(); resolve(); };
  });
  // Forms may be sent to other sites without asking them; what they answer opens in a frame.
  const frame = Object.assign(document.createElement("iframe"), { name: "inside" });
  document.body.append(frame);
  for (const enctype of ["text/plain", "application/x-www-form-urlencoded"]) {
    const form = Object.assign(document.createElement("form"), { method: "post", action: `${address}/v1/plans`, enctype, target: "inside" });
    form.append(Object.assign(document.createElement("input"), { name: scenario }));
    document.body.append(form);
    await new Promise((resolve) => {
      frame.onload = resolve;
      form.submit();
    });
    seen[`form of ${enctype}`] = frame.contentDocument?.body.textContent || "nothing";
  }
  return seen;
}

async function fromElsewhere(browser, url, target) {
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto(url);
  const seen = await page.evaluate(tried, target);
  for (const [name, what] of Object.entries(seen)) check(["nothing", "opaque 0 "].includes(what), `${name}: ${what}`);
  // A window may be opened like a link; it cannot be looked into.
  const [opened, looked] = await Promise.all([
    context.waitForEvent("page"),
    page.evaluate(async (address) => {
      const other = open(`${address}/v1/plans`);
      for (;;) {
        try {
          if (other.document.body?.textContent) return other.document.body.textContent;
        } catch (error) {
          return error.name;
        }
        await new Promise((resolve) => { setTimeout(resolve, 20); });
      }
    }, target.address),
  ]);
  check(looked === "SecurityError", looked);
  await opened.waitForLoadState();
  await context.close();
  return Object.keys(seen).length;
}

/** The page came when its name still led to a server of its owner: only that answer is not the service's. */
async function rebound(browser, target) {
  const context = await browser.newContext();
  const page = await context.newPage();
  const address = target.address.replace("127.0.0.1", NAME);
  const first = `${address}/first`;
  await page.route(first, (route) => route.fulfill({ contentType: "text/html", body: PAGE }));
  await page.goto(first);
  const seen = await page.evaluate(tried, { ...target, address });
  for (const [name, what] of Object.entries(seen)) {
    const refused = what.startsWith("basic 403 ") && what.includes('"foreign_host"');
    check(what === "nothing" || refused, `${name}: ${what}`);
  }
  check(seen.GET !== "nothing", "the service does not answer");
  await context.close();
  return Object.keys(seen).length;
}

async function followed(browser, url, { address, scenario }) {
  const context = await browser.newContext();
  const page = await context.newPage();
  for (const path of ["/", "/docs/"]) {
    await page.goto(url);
    await page.evaluate((to) => {
      document.body.append(Object.assign(document.createElement("a"), { href: to, textContent: "to the service" }));
    }, address + path);
    const [answer] = await Promise.all([
      page.waitForResponse(address + path),
      page.getByRole("link", { name: "to the service" }).click(),
    ]);
    check(answer.status() === 200, `${path}: ${answer.status()}`);
  }
  await page.goto(address);
  await page.getByRole("link", { name: "two-targets" }).first().waitFor();
  const status = await page.evaluate(async (body) => {
    const headers = { "Content-Type": "application/json" };
    return (await fetch("/v1/plans", { method: "POST", headers, body })).status;
  }, scenario);
  check(status === 202, `its own post: ${status}`);
  await context.close();
}

// A service of its own, a browser, and pages that note whatever goes wrong in them.

import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";

const tools = createRequire(join(process.env.BROWSER_TOOLS, "package.json"));
const { chromium } = tools("playwright-core");
const AXE = readFileSync(tools.resolve("axe-core/axe.min.js"), "utf8");
const ROOT = fileURLToPath(new URL("../../", import.meta.url));

export function fixture(name) {
  return JSON.parse(readFileSync(join(ROOT, "tests/fixtures", `${name}.json`), "utf8"));
}

/** A phone held upright. */
export const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

/** The first stars of the catalogue, with its head. */
export function stars(count) {
  return readFileSync(join(ROOT, "tests/fixtures/bright-stars.csv"), "utf8").split("\n").slice(0, count + 1).join("\n");
}

/** Throws with a message unless something holds. */
export function check(holds, message) {
  if (!holds) throw new Error(message);
}

/** Until when a page must show what it was told to, ms. */
const PATIENCE_MS = 30_000;

/** Looks again until a look throws nothing: what it throws last, if that takes too long. */
export async function eventually(look) {
  const until = Date.now() + PATIENCE_MS;
  for (;;) {
    try {
      return await look();
    } catch (error) {
      if (Date.now() > until) throw error;
      await new Promise((resolve) => { setTimeout(resolve, 50); });
    }
  }
}

/** `slewplan serve` on a free port and a fresh database; with a key if asked for. */
export async function startService({ withKey = false } = {}) {
  const folder = mkdtempSync(join(tmpdir(), "slewplan-browser-"));
  const database = join(folder, "page.db");
  const program = process.env.SLEWPLAN;
  const key = withKey
    ? execFileSync(program, ["keys", "create", "planner", "--database", database], { encoding: "utf8" }).trim()
    : null;
  const child = spawn(program, ["serve", "--listen", "127.0.0.1:0", "--database", database, "--log", "warn"],
    { stdio: ["ignore", "pipe", "inherit"] });
  const lines = createInterface({ input: child.stdout });
  const address = await new Promise((resolve, reject) => {
    lines.once("line", (line) => resolve(line.replace("listening on ", "").trim()));
    child.once("exit", (code) => reject(new Error(`the service ended with ${code}`)));
  });
  const stop = async () => {
    child.kill("SIGTERM");
    await new Promise((resolve) => child.once("exit", resolve));
    rmSync(folder, { recursive: true });
  };
  return { address, key, stop };
}

/** Submits a scenario and waits for its plan; the identifier of the job. */
export async function planned(service, scenario) {
  const answer = await fetch(`${service.address}/v1/plans`, {
    method: "POST", headers: { "Content-Type": "application/json", Prefer: "wait=60" }, body: JSON.stringify(scenario),
  });
  check(answer.ok, `a plan answered ${answer.status}`);
  const id = answer.headers.get("location").split("/").at(-1);
  // A machine with other work to do takes longer than the service waits.
  for (let state = "running"; ["queued", "running"].includes(state);) {
    ({ state } = await (await fetch(`${service.address}/v1/plans/${id}`)).json());
    if (["queued", "running"].includes(state)) await new Promise((resolve) => { setTimeout(resolve, 500); });
  }
  return id;
}

/** A browser, with further options of its command line. */
export function openBrowser(options = []) {
  const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
  // Containers have neither a sandbox of their own for it nor much shared memory.
  return chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-dev-shm-usage", ...options] });
}

/** A page of a browser; `complaints` collects errors of the console and requests elsewhere. */
export async function openPage(browser, service, options = {}) {
  const { expected = [], ...context } = options;
  const opened = await browser.newContext({ viewport: { width: 1280, height: 900 }, acceptDownloads: true, ...context });
  const page = await opened.newPage();
  page.setDefaultTimeout(120_000);
  const complaints = [];
  const note = (text) => expected.some((pattern) => pattern.test(text)) || complaints.push(text);
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && note(`console: ${message.text()}`));
  page.on("pageerror", (error) => note(`script: ${error.stack}`));
  page.on("request", (request) => {
    const { protocol, origin } = new URL(request.url());
    if (!["blob:", "data:"].includes(protocol) && origin !== service.address) note(`elsewhere: ${request.url()}`);
  });
  return { page, complaints, close: () => opened.close() };
}

/** What axe-core finds, one line each. */
export async function findings(page) {
  await page.evaluate(AXE);
  const { violations } = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
  const places = (one) => one.nodes.slice(0, 3).map((node) => node.target.join(" ")).join("; ");
  return violations.map((one) => `${one.impact} ${one.id}: ${one.help} (${places(one)})`);
}

/** All of a page as a file, where SCREENSHOTS names a folder. */
export async function picture(page, name) {
  const folder = process.env.SCREENSHOTS;
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await page.screenshot({ path: join(folder, `${name}.png`), fullPage: true });
}

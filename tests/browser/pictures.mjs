// Every drawing as a file of its own: SVG with letters and lines, PNG with the pixels of it.

import { readFileSync } from "node:fs";
import { check, fixture, openPage, planned } from "./harness.mjs";

/** The drawings of a plan. */
const DRAWINGS = ["sky", "body", "timelines", "legs", "leg times", "search"];
const SURFACES = { light: [255, 255, 255], dark: [25, 29, 34] };

/** Saves a drawing by its button; its name and bytes. */
async function saved(page, name, kind) {
  const button = page.getByRole("button", { name: `Save ${name} as ${kind}`, exact: true });
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

export async function pictures({ browser, service, must }) {
  const id = await planned(service, fixture("two-targets"));
  for (const [theme, surface] of Object.entries(SURFACES)) {
    const { page, complaints, close } = await openPage(browser, service, { colorScheme: theme });
    await page.goto(`${service.address}/#/plans/${id}`);
    await page.locator(".matrix td.number").first().waitFor();
    await page.locator(".search .uplot").first().waitFor();
    await page.locator(".sphere .stop").first().waitFor();
    for (const drawing of DRAWINGS) {
      await must(`the ${drawing} as SVG and PNG, ${theme}`, async () => {
        const svg = await saved(page, drawing, "SVG");
        const found = await examined(page, svg.bytes.toString("utf8"));
        check(/^[a-z-]+\.svg$/.test(svg.name), svg.name);
        check(found.texts > 0 && found.shapes > 0, `${found.texts} texts, ${found.shapes} shapes`);
        check(found.outside.length === 0, `refers to ${found.outside.join()}`);
        check(found.unfit.length === 0, `colours ${found.unfit.join()}`);
        check(found.ground.join() === surface.join(), `on ${found.ground.join()}`);
        const png = await saved(page, drawing, "PNG");
        const [width, height] = [16, 20].map((at) => png.bytes.readUInt32BE(at));
        check(png.bytes.subarray(1, 4).toString() === "PNG" && width === Math.round(2 * found.width) && height === Math.round(2 * found.height),
          `${width} by ${height} for ${found.width} by ${found.height}`);
        const seen = await colours(page, png.bytes.toString("base64"));
        check(seen.first.join() === surface.join(), `its corner is ${seen.first.join()}`);
        check(seen.number > 8, `${seen.number} colours`);
        return `${svg.name} ${svg.bytes.length} bytes, ${png.name} ${png.bytes.length} bytes`;
      });
    }
    await must(`the curves of the saved timelines are those of the plan, ${theme}`, async () => {
      const plan = await (await fetch(`${service.address}/v1/plans/${id}/result`)).json();
      const { bytes } = await saved(page, "timelines", "SVG");
      // Of the x rate: as many points as there are samples, the highest where the rate is highest.
      const paths = [...bytes.toString("utf8").matchAll(/<path d="(M[^"]+)"[^>]*stroke-width="1.5"/g)].map(([, d]) =>
        d.slice(1).split("L").map((point) => point.split(" ").map(Number)));
      const rates = plan.trajectory.states.map((state) => state.body_rate_rad_s[0]);
      check(paths[0].length === rates.length, `${paths[0].length} points for ${rates.length} samples`);
      const heights = paths[0].map(([, y]) => y);
      const at = (list, most) => list.indexOf(most(...list));
      const highest = rates[at(heights, Math.min)];
      check(Math.abs(highest - Math.max(...rates)) < 1e-3 * Math.max(...rates), `${highest} is highest`);
    });
    await must(`no error of the console while saving, ${theme}`, () => check(complaints.length === 0, complaints.join("\n")));
    await close();
  }
}

/** What is in an SVG document, read by the browser as XML. */
const examined = (page, text) => page.evaluate((svg) => {
  const root = new DOMParser().parseFromString(svg, "image/svg+xml").documentElement;
  if (root.localName !== "svg") throw new Error(root.textContent);
  const all = [...root.querySelectorAll("*")];
  const inks = all.flatMap((node) => ["fill", "stroke"].map((name) => node.getAttribute(name)).filter(Boolean));
  return {
    width: Number(root.getAttribute("width")), height: Number(root.getAttribute("height")),
    texts: root.querySelectorAll("text").length, shapes: root.querySelectorAll("path, rect, circle, line").length,
    // Nothing but what is in the file.
    outside: all.flatMap((node) => [node.getAttribute("href"), node.getAttribute("class"), node.getAttribute("style")].filter((value) => value && !value.startsWith("data:") && value !== "image-rendering: pixelated")),
    unfit: [...new Set(inks.filter((ink) => !/^(none|#[0-9a-f]{3,8}|rgba?\([\d., ]+\))$/i.test(ink)))],
    ground: root.querySelector("rect").getAttribute("fill").match(/\d+/g).map(Number),
  };
}, text);

/** The first pixel of a picture, and how many colours it has. */
const colours = (page, base64) => page.evaluate(async (data) => {
  const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
  const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
  const ink = new OffscreenCanvas(image.width, image.height).getContext("2d");
  ink.drawImage(image, 0, 0);
  const pixels = ink.getImageData(0, 0, image.width, image.height).data;
  const seen = new Set();
  for (let at = 0; at < pixels.length; at += 4) seen.add((pixels[at] << 16) | (pixels[at + 1] << 8) | pixels[at + 2]);
  return { first: [...pixels.slice(0, 3)], number: seen.size };
}, base64);

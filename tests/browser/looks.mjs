// Every view at three widths, in both themes and enlarged: nothing cut off, nothing that axe-core finds.

import { check, findings, fixture, openPage, picture, planned } from "./harness.mjs";

/** Enlarged to 200 %: half as many pixels of the page, each twice as large. */
const SIZES = {
  desktop: { viewport: { width: 1280, height: 900 } },
  tablet: { viewport: { width: 820, height: 1180 }, hasTouch: true },
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true },
  zoomed: { viewport: { width: 640, height: 450 }, deviceScaleFactor: 2 },
};

/** Views that are complete once they have been sent, and by which button. */
const SENT = {
  slew: "Solve", trade: "Solve", study: "Run", "study-envelopes": "Run", "study-comparison": "Run", "study-flight": "Run",
};
/** How many plots studies without a flight have. */
const PLOTS = { study: 3, "study-envelopes": 4, "study-comparison": 7 };

export async function looks({ browser, service, must }) {
  const ids = {};
  for (const name of ["two-targets", "olivares-a", "pyramid-momentum-bias"]) {
    ids[name] = await planned(service, fixture(name));
  }
  const views = {
    list: "#/", new: "#/new?example=olivares-a", blank: "#/new", stars: "#/new?example=stars-and-sun", plan: `#/plans/${ids["olivares-a"]}`,
    "keep-out": `#/plans/${ids["two-targets"]}`, pyramid: `#/plans/${ids["pyramid-momentum-bias"]}`,
    slew: "#/slew?example=quarter-turn", trade: "#/slew?example=olrac-four-wheels",
    study: "#/studies?example=study-authority",
    ...Object.fromEntries(["envelopes", "comparison", "flight"].map((name) => [`study-${name}`, `#/studies/${name}?example=study-${name}`])),
    compare: `#/compare/${ids["olivares-a"]}/${ids["two-targets"]}`,
  };
  for (const [size, context] of Object.entries(SIZES)) {
    for (const theme of ["light", "dark"]) {
      const { page, complaints, close } = await openPage(browser, service, { ...context, colorScheme: theme });
      for (const [view, path] of Object.entries(views)) {
        await must(`${view}, ${size}, ${theme}`, async () => {
          await page.goto("about:blank");
          await page.goto(`${service.address}/${path}`);
          await ready(page, view);
          await picture(page, `${view}-${size}-${theme}`);
          const found = await findings(page);
          check(found.length === 0, found.join("\n"));
          await uncut(page);
          if (view === "list") await namedInWords(page);
        });
      }
      await must(`the console is silent, ${size}, ${theme}`, () => check(complaints.length === 0, complaints.join("\n")));
      await close();
    }
  }
  await largeType({ browser, service, must }, views);
}

/** The view with everything in it, at a moment in the middle of the flight. */
async function ready(page, view) {
  if (view === "list") return page.locator("tbody tr").first().waitFor();
  if (view === "blank") return page.getByText("No targets yet").waitFor();
  if (view === "new" || view === "stars") {
    await page.getByText("No problems").waitFor();
    return page.locator(".desk-sphere .place-name").first().waitFor();
  }
  if (view in SENT) await send(page, SENT[view]);
  else if (view === "compare") await page.locator(".sphere .stop").nth(7).waitFor();
  else await Promise.all([".sphere .stop", ".search .uplot", ".matrix"].map((part) => page.locator(part).first().waitFor()));
  if (view in PLOTS) return page.locator(".curves .uplot").nth(PLOTS[view] - 1).waitFor();
  await page.getByLabel("Moment").evaluate((slider) => {
    slider.value = String(0.4 * Number(slider.max));
    slider.dispatchEvent(new Event("input"));
  });
  return page.waitForFunction(() => !document.querySelector(".playback-moment").textContent.startsWith("0.0 s"));
}

/** Names of plans have room for words, whatever else is in their rows. */
async function namedInWords(page) {
  const widths = await page.locator("tbody th[scope=row]").evaluateAll((all) => all.map((cell) => cell.clientWidth));
  check(widths.length > 0 && Math.min(...widths) >= 100, `names of ${Math.min(...widths)} px`);
}

async function send(page, verb) {
  await page.waitForFunction(() => document.querySelector("textarea").value.length > 0);
  await page.getByRole("button", { name: verb, exact: true }).click();
  await page.locator(".result .uplot").first().waitFor();
}

/** Letters of twice the size, for those who set them so. */
async function largeType({ browser, service, must }, views) {
  const { page, close } = await openPage(browser, service);
  // Set before the page looks, as a setting of the browser is, which pictures would not show.
  await page.addInitScript(() => {
    new MutationObserver((_, watcher) => {
      document.documentElement.style.setProperty("font-size", "200%");
      watcher.disconnect();
    }).observe(document, { childList: true });
  });
  for (const [view, path] of Object.entries(views)) {
    await must(`${view}, letters of twice the size`, async () => {
      await page.goto("about:blank");
      await page.goto(`${service.address}/${path}`);
      await ready(page, view);
      await picture(page, `${view}-large-type`);
      await uncut(page);
    });
  }
  await close();
}

/** Nothing is wider than the window, and no text is cut off where it cannot be scrolled to. */
async function uncut(page) {
  const cut = await page.evaluate(() => {
    const found = [];
    const { scrollWidth, clientWidth } = document.documentElement;
    if (scrollWidth > clientWidth) found.push(`the page is ${scrollWidth - clientWidth} px too wide`);
    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let text = texts.nextNode(); text; text = texts.nextNode()) {
      const owner = text.parentElement;
      if (!text.data.trim() || owner.closest(".unseen, .skip, noscript, option, textarea, script") || !owner.checkVisibility()) continue;
      const range = document.createRange();
      range.selectNodeContents(text);
      const box = range.getBoundingClientRect();
      if (box.width === 0) continue;
      const scrolled = owner.closest(".scroll, .order");
      if (!scrolled && (box.left < -1 || box.right > clientWidth + 1)) found.push(`"${text.data}" leaves the window`);
      for (let around = owner; around && !around.matches(".scroll, .order"); around = around.parentElement) {
        if (getComputedStyle(around).overflowX === "visible") continue;
        const limit = around.getBoundingClientRect();
        if (box.left < limit.left - 1 || box.right > limit.right + 1) found.push(`"${text.data}" is cut by ${around.className}`);
      }
    }
    return found;
  });
  check(cut.length === 0, cut.slice(0, 5).join("; "));
}

// Measures the pages of `coinmc report` and `coinmc trace -o toss.html` in headless Chromium: size, time to
// open, messages, requests, violations of accessibility, width on a phone, and work for a frame of a toss.
//
//     npm ci --prefix benches/web && node benches/web/measure.mjs PAGE.html… > pages.csv
//
//   CHROMIUM   the browser     [/usr/bin/chromium]

import { createRequire } from "node:module";
import { readFileSync, statSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const COLUMNS = [
  "page", "kilobytes", "open_ms", "messages", "requests", "violations", "narrow_px", "frame_work_ms", "frames_per_s",
];

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: SOFTWARE });
console.log(COLUMNS.join(","));
for (const file of process.argv.slice(2)) {
  const row = { page: file.split("/").pop(), kilobytes: Math.round(statSync(file).size / 1000), ...(await measure(file)) };
  console.log(COLUMNS.map((column) => row[column] ?? "").join(","));
}
await browser.close();

async function measure(file) {
  const page = await browser.newPage({ viewport: { width: 1100, height: 900 } });
  let messages = 0, requests = 0;
  page.on("console", () => (messages += 1));
  page.on("pageerror", (error) => {
    messages += 1;
    console.error(`${file}: ${error.message}`);
  });
  page.on("request", (request) => (requests += /^(file|data|blob):/.test(request.url()) ? 0 : 1));
  const address = pathToFileURL(resolve(file)).href;
  await page.goto(address);
  const opened = () => performance.getEntriesByType("navigation")[0].loadEventEnd;
  const times = [await page.evaluate(opened)];
  for (let i = 0; i < 4; i += 1) {
    await page.goto(address);
    times.push(await page.evaluate(opened));
  }
  const open_ms = Math.round(times.sort((a, b) => a - b)[2]);
  const frames = await played(page);
  const violations = await accessibility(page, file);
  await page.setViewportSize({ width: 360, height: 740 });
  await page.goto(address);
  await page.waitForTimeout(500);
  const narrow_px = await page.evaluate(() => document.documentElement.scrollWidth);
  await page.close();
  return { open_ms, messages, requests, violations, narrow_px, ...frames };
}

/** Work and number of frames while a toss plays; nothing where the page shows none. */
async function played(page) {
  const place = page.locator(".viewer-place, .viewer").first();
  if (!(await place.count())) return {};
  await place.scrollIntoViewIfNeeded();
  await page.waitForSelector(".viewer canvas");
  return page.evaluate(async () => {
    const [button] = document.querySelectorAll(".viewer .primary");
    if (button.textContent === "Play") button.click();
    const canvas = document.querySelector(".stage canvas");
    const work = [];
    let frames = 0;
    const began = performance.now();
    while (performance.now() - began < 2000) {
      await new Promise(requestAnimationFrame);
      frames += 1;
      work.push(Number(canvas.dataset.frameMs));
    }
    work.sort((a, b) => a - b);
    return { frame_work_ms: work[Math.floor(0.95 * work.length)], frames_per_s: Math.round(frames / 2) };
  });
}

/** Serious and critical violations, in light and in dark. */
async function accessibility(page, file) {
  const session = await page.context().newCDPSession(page);
  await session.send("Page.setBypassCSP", { enabled: true });
  let found = 0;
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    await session.send("Runtime.evaluate", { expression: AXE });
    const { violations } = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
    for (const { id, impact, nodes } of violations) {
      console.error(`${file}: ${impact}: ${id}: ${nodes[0].html.slice(0, 120)}`);
      found += impact === "serious" || impact === "critical" ? nodes.length : 0;
    }
  }
  return found;
}

// How fast the page is: node benches/page/measure.mjs [FOLDER]
//
// Opens the page that scripts/web-page built in headless Chromium, and prints the time from opening it to
// the first toss shown, the tosses per second of one worker, and those of the program on one thread.
// Needs Chromium, a release build, and puppeteer-core (npm install --no-save puppeteer-core).
import { execFileSync } from "node:child_process";
import fs from "node:fs";
import http from "node:http";
import os from "node:os";
import path from "node:path";
import { pathToFileURL } from "node:url";
import puppeteer from "puppeteer-core";

const folder = process.argv[2] ?? "target/web-page";
const program = "target/release/coinmc";
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };
/** A config of examples/, the point of its sweep, and tosses of about a second. */
const CASES = [
  ["first.toml", 1, 200_000],
  ["clean.toml", 1, 10_000],
  ["hand.toml", 1, 1_000],
];
const ROUNDS = 3;

const server = http.createServer((request, response) => {
  const file = path.join(folder, request.url === "/" ? "index.html" : path.basename(request.url));
  fs.readFile(file, (error, bytes) => {
    response.writeHead(error ? 404 : 200, { "content-type": TYPES[path.extname(file)] ?? "" });
    response.end(bytes);
  });
});
await new Promise((done) => server.listen(0, "127.0.0.1", done));
const { port } = server.address();
const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const browser = await puppeteer.launch({ executablePath, args: ["--no-sandbox"] });

/** Opens the page anew; the milliseconds to its first toss, and what it complained of. */
async function opened(url) {
  const page = await browser.newPage();
  const complaints = [];
  page.on("console", (message) => complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.message));
  await page.goto(url);
  await page.waitForFunction(() => document.documentElement.dataset.firstTossMs);
  const ms = await page.evaluate(() => Number(document.documentElement.dataset.firstTossMs));
  return { page, ms, complaints };
}

const median = (values) => values.toSorted((a, b) => a - b)[values.length >> 1];

for (const [name, url] of [
  ["from a server", `http://127.0.0.1:${port}/`],
  ["from a file", pathToFileURL(path.resolve(folder, "index.html")).href],
]) {
  const times = [];
  for (let i = 0; i < ROUNDS; i++) {
    const { page, ms, complaints } = await opened(url);
    times.push(ms);
    if (complaints.length) console.log(complaints.join("\n"));
    await page.close();
  }
  console.log(`first toss, ${name}: ${median(times)} ms (median of ${ROUNDS})`);
}

const { page } = await opened(`http://127.0.0.1:${port}/`);
await page.evaluate(() => coinmc.page.hold());
const scratch = fs.mkdtempSync(path.join(os.tmpdir(), "coinmc-page-"));
for (const [name, point, tosses] of CASES) {
  const config = fs.readFileSync(path.join("examples", name), "utf8");
  const question = { ask: "toss", config, point, from: 0, to: tosses };
  const [here, native] = [[], []];
  for (let i = 0; i < ROUNDS; i++) {
    const ms = await page.evaluate(async (question) => {
      const worker = new coinmc.Worker(coinmc.page.module);
      await worker.ask({ ...question, to: question.to / 10 }); // compiled, and warm
      const { took } = await worker.ask(question);
      worker.end();
      return took;
    }, question);
    here.push(tosses / (ms / 1000));
    native.push(rate(name, point, tosses, path.join(scratch, `${name}-${i}`)));
  }
  const [a, b] = [median(here), median(native)];
  console.log(`${name}, point ${point}: ${a.toFixed(0)} a second in a worker, ${b.toFixed(0)} on one thread, × ${(b / a).toFixed(1)}`);
}
fs.rmSync(scratch, { recursive: true });
await browser.close();
server.close();

/** Tosses per second of the program, for that point alone. */
function rate(name, point, tosses, out) {
  const ratio = { "first.toml": 1.0, "clean.toml": 0.85, "hand.toml": 0.7 }[name];
  const more = 10; // so that starting it does not count
  const set = [`coin.ratio=${ratio}`, `stop.tosses=${more * tosses}`].flatMap((s) => ["--set", s]);
  const begun = performance.now();
  execFileSync(program, ["run", path.join("examples", name), "--out", out, "--quiet", "--threads", "1", ...set]);
  return (more * tosses) / ((performance.now() - begun) / 1000);
}

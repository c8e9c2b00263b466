// The page's own scripts and its module in Node, for tests: as a browser has them, without the page.
import fs from "node:fs";
import path from "node:path";
import vm from "node:vm";

/** The object `coinmc` of the page in a folder, and a kernel. */
export async function load(folder) {
  for (const name of ["kernel.js", "count.js", "scene.js"]) {
    vm.runInThisContext(fs.readFileSync(path.join(folder, name), "utf8"), { filename: name });
  }
  const module = await WebAssembly.compile(fs.readFileSync(path.join(folder, "coinmc.wasm")));
  const { coinmc } = globalThis;
  return { coinmc, kernel: new coinmc.Kernel(await WebAssembly.instantiate(module)) };
}

/** Workers that take turns in one thread; the first, which has the first tosses, answers last. */
export function workers(kernel, count) {
  return Array.from({ length: count }, (_, i) => ({
    async ask(question) {
      const begun = performance.now();
      const answer = kernel.ask(question);
      const took = performance.now() - begun;
      await new Promise((done) => setTimeout(done, 20 * (count - 1 - i)));
      return { answer, took };
    },
  }));
}

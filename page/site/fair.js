// The ratio at which the side comes up in a third of the tosses.
"use strict";
globalThis.coinmc ??= {};

/** Half widths asked for, one after another: an answer soon, a sharper one later. */
coinmc.HALF_WIDTHS = [0.05, 0.02, 0.01, 0.005];
/** Tosses after which a search stops short of its half width. */
const MOST_TOSSES = 2_000_000;

/**
 * Searches in a worker of its own, and tells of each answer.
 *
 * @param {(found: {roots: object[], confidence: number, tosses: number, done: boolean}) => void} tell
 * @returns a function that stops it
 */
coinmc.findFair = function (module, config, tell, failed) {
  const worker = new coinmc.Worker(module);
  (async () => {
    for (const halfWidth of coinmc.HALF_WIDTHS) {
      const question = { ask: "fair", config, half_width: halfWidth, max_tosses: MOST_TOSSES };
      const { answer } = await worker.ask(question);
      const [{ roots }] = answer.curves;
      const done =
        halfWidth === coinmc.HALF_WIDTHS.at(-1) || !roots.length || roots.some((r) => !r.reached);
      tell({ roots, confidence: answer.confidence, tosses: answer.tosses, done });
      if (done) break;
    }
    worker.end();
  })().catch((error) => {
    worker.end();
    failed(error);
  });
  return () => worker.end();
};

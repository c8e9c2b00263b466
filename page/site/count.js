// Counting the tosses of a config with all workers.
"use strict";
globalThis.coinmc ??= {};

/** Work for a worker takes about this long, ms: short enough to stop, long enough to be worth asking. */
const PIECE_MS = 60;
/** Tosses of the very first piece of each worker. */
const FIRST_PIECE = 32;

/** The sum of two tallies. */
coinmc.added = function (sum, tally) {
  const counts = { ...sum };
  for (const [name, count] of Object.entries(tally)) counts[name] = (counts[name] ?? 0) + count;
  return counts;
};

/**
 * Tosses 0 … tosses − 1 of a config, in pieces that the workers take as they are free.
 *
 * What it shows is always the tosses from the first one on without a gap: so the numbers do not favour
 * tosses that are quick to compute, and n tosses are the same n however many workers there are.
 */
coinmc.Count = class {
  /**
   * @param {{ask: Function}[]} workers
   * @param {string} config
   * @param {number} tosses
   * @param {(found: {tally: object, tosses: number, ms: number, done: boolean}) => void} show
   */
  constructor(workers, config, tosses, show) {
    Object.assign(this, { workers, config, tosses, show });
    this.next = 0; // the first toss that no worker has
    this.whole = 0; // all tosses below it are in the tally
    this.tally = {};
    this.ahead = new Map(); // finished pieces beyond, by their first toss
    this.stopped = false;
  }

  /** Ends when all is counted or it was stopped. */
  async run() {
    this.begun = performance.now();
    await Promise.all(this.workers.map((worker) => this.work(worker)));
  }

  stop() {
    this.stopped = true;
  }

  async work(worker) {
    let size = FIRST_PIECE;
    while (!this.stopped && this.next < this.tosses) {
      const from = this.next;
      const to = Math.min(from + size, this.tosses);
      this.next = to;
      const question = { ask: "toss", config: this.config, from, to };
      const { answer, took } = await worker.ask(question);
      if (this.stopped) return;
      this.add(from, to, answer.tally);
      const wanted = ((to - from) * PIECE_MS) / Math.max(took, 0.1);
      size = Math.round(Math.min(Math.max(wanted, 1), 8 * size));
    }
  }

  add(from, to, tally) {
    this.ahead.set(from, { to, tally });
    const before = this.whole;
    for (let piece; (piece = this.ahead.get(this.whole)); ) {
      this.ahead.delete(this.whole);
      this.tally = coinmc.added(this.tally, piece.tally);
      this.whole = piece.to;
    }
    if (this.whole > before) {
      const ms = performance.now() - this.begun;
      const done = this.whole === this.tosses;
      this.show({ tally: this.tally, tosses: this.whole, ms, done });
    }
  }
};

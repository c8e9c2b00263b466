// How sharply moving coins are drawn: with fewer pixels where frames come late, as without a graphics processor.

/** Longest time between frames that still are 60 a second, ms, and one after which nothing moves. */
const ON_TIME = 18, AT_REST = 250;
/** Late frames after which there are fewer pixels, and how many times fewer along each side, at most 2. */
const PATIENCE = 5, STEP = 0.8, LEAST = 0.5;

export class Sharpness {
  /** `apply` is called with every new share of the full number of pixels along a side. */
  constructor(apply) {
    Object.assign(this, { apply, share: 1, late: 0, last: -Infinity, whole: null });
    /** The share that was enough when coins last moved. */
    this.moving = 1;
  }

  /** A frame is to be drawn. Still pictures are drawn again with all pixels. */
  frame(now) {
    const gap = now - this.last;
    this.last = now;
    clearTimeout(this.whole);
    if (gap < AT_REST) {
      this.late = gap > ON_TIME ? this.late + 1 : Math.max(0, this.late - 0.5);
      if (this.late >= PATIENCE) {
        this.moving = Math.max(LEAST, this.moving * STEP);
        this.late = 0;
      }
      this.take(this.moving);
    }
    if (this.share < 1) this.whole = setTimeout(() => this.take(1), AT_REST);
  }

  take(share) {
    if (share === this.share) return;
    this.share = share;
    this.apply(share);
  }
}

// The time shown: played at some speed, slower around impacts, or set by the reader.

/** Slowest speed around an impact, as a share of the chosen one. */
const SLOW = 0.08;

export class Clock {
  /**
   * `impacts`: times that are slowed down around; `window`: how far around, s. `tick` is called with every
   * new time, `state` when playing begins or ends.
   */
  constructor({ duration, impacts, window, tick, state }) {
    Object.assign(this, { duration, impacts, window, tick, state });
    this.time = 0;
    this.speed = 1;
    this.slows = true;
    this.playing = false;
    this.last = null;
    this.frame = (now) => this.step(now);
  }

  set(time) {
    this.time = Math.min(this.duration, Math.max(0, time));
    this.tick(this.time);
  }

  play() {
    if (this.playing) return;
    if (this.time >= this.duration) this.set(0);
    this.playing = true;
    this.last = null;
    this.state(true);
    requestAnimationFrame(this.frame);
  }

  pause() {
    this.playing = false;
    this.state(false);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  step(now) {
    if (!this.playing) return;
    // a page that was hidden does not jump
    let left = this.last === null ? 0 : Math.min(0.05, (now - this.last) / 1000);
    this.last = now;
    let time = this.time;
    // steps so small that no impact is jumped over
    while (left > 0) {
      const rate = this.rate(time);
      const step = Math.min(left, this.window / 8 / rate);
      time += step * rate;
      left -= step;
    }
    this.set(time);
    if (this.time >= this.duration) this.pause();
    else requestAnimationFrame(this.frame);
  }

  /** Seconds of the toss for each second of the reader. */
  rate(time) {
    if (!this.slows) return this.speed;
    const away = Math.min(1, this.distance(time) / this.window);
    const smooth = away * away * (3 - 2 * away);
    return this.speed * (SLOW + (1 - SLOW) * smooth);
  }

  /** Time to the nearest impact. */
  distance(time) {
    let low = 0, high = this.impacts.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.impacts[middle] < time) low = middle + 1;
      else high = middle;
    }
    const near = [this.impacts[low - 1], this.impacts[low]].filter((t) => t !== undefined);
    return Math.min(Infinity, ...near.map((t) => Math.abs(t - time)));
  }
}

// A camera that turns around a point: by mouse, by one or two fingers, and by keys.

const LOWEST = 0.03, HIGHEST = 1.54;

export class Orbit {
  /** `changed` is called whenever the view has to be drawn again. */
  constructor(canvas, changed) {
    this.changed = changed;
    this.pointers = new Map();
    /** What is looked at, and from how far before the reader comes nearer. */
    this.target = [0, 0, 0];
    this.reach = 1;
    this.reset();
    canvas.addEventListener("pointerdown", (event) => this.down(canvas, event));
    canvas.addEventListener("pointermove", (event) => this.move(canvas, event));
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener("wheel", (event) => this.wheel(canvas, event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  reset() {
    Object.assign(this, { azimuth: -1.15, elevation: 0.3, nearer: 1 });
    this.changed();
  }

  /** Turns by angles, and comes nearer by a factor. */
  turn(azimuth, elevation, nearer = 1) {
    this.azimuth += azimuth;
    this.elevation = Math.min(HIGHEST, Math.max(LOWEST, this.elevation + elevation));
    this.nearer = Math.min(30, Math.max(0.1, this.nearer * nearer));
    this.changed();
  }

  get distance() {
    return this.reach / this.nearer;
  }

  /** Where the eye is. */
  eye() {
    const flat = this.distance * Math.cos(this.elevation);
    return [
      this.target[0] + flat * Math.cos(this.azimuth),
      this.target[1] + flat * Math.sin(this.azimuth),
      this.target[2] + this.distance * Math.sin(this.elevation),
    ];
  }

  down(canvas, event) {
    canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
  }

  move(canvas, event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const span = () => {
      const [a, b] = [...this.pointers.values()];
      return b ? Math.hypot(a[0] - b[0], a[1] - b[1]) : 0;
    };
    const apart = span();
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    const scale = (this.pointers.size > 1 ? 1.5 : 3) / canvas.clientHeight;
    const [x, y] = [event.clientX - before[0], event.clientY - before[1]];
    this.turn(-x * scale, y * scale, apart > 0 ? span() / apart : 1);
  }

  // only with focus: a page is scrolled more often than a toss is looked at
  wheel(canvas, event) {
    if (document.activeElement !== canvas) return;
    event.preventDefault();
    this.turn(0, 0, Math.exp(-event.deltaY * 0.0015));
  }

  key(event) {
    const step = 0.12;
    const moves = {
      ArrowLeft: () => this.turn(-step, 0),
      ArrowRight: () => this.turn(step, 0),
      ArrowUp: () => this.turn(0, step),
      ArrowDown: () => this.turn(0, -step),
      "+": () => this.turn(0, 0, 1.15),
      "=": () => this.turn(0, 0, 1.15),
      "-": () => this.turn(0, 0, 1 / 1.15),
      Home: () => this.reset(),
    };
    const found = moves[event.key];
    if (!found || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    found();
  }
}

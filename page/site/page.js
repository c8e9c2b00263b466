// The page: from the form to counts, a toss and a config.
"use strict";
globalThis.coinmc ??= {};

/** States of a toss that is drawn. */
const STATES = 4000;
/** Most workers: more do not fit a phone's memory. */
const MOST_WORKERS = 16;

const $ = (id) => document.getElementById(id);
const form = $("scene");

coinmc.Page = class {
  constructor(module, about) {
    this.module = module;
    this.kernel = new coinmc.Kernel(new WebAssembly.Instance(module));
    this.launches = about.launches;
    const cores = Math.min(navigator.hardwareConcurrency || 2, MOST_WORKERS);
    this.workers = Array.from({ length: cores }, () => new coinmc.Worker(module));
    this.player = new coinmc.Player($("toss"), (time, playing) => this.showTime(time, playing));
    this.toss = 0;
    this.listen();
    this.changed();
  }

  listen() {
    form.addEventListener("input", () => {
      clearTimeout(this.soon);
      this.labels();
      this.soon = setTimeout(() => this.changed(), 120);
    });
    form.elements.launch.addEventListener("change", () => this.launchChosen());
    $("hold").addEventListener("click", () => (this.count ? this.hold() : this.begin()));
    $("fair").addEventListener("click", () => (this.stopFair ? this.endFair() : this.findFair()));
    $("use").addEventListener("click", () => this.useFair());
    $("copy").addEventListener("click", () => this.copy());
    $("save").addEventListener("click", () => this.save());
    $("play").addEventListener("click", () => this.player.play(!this.player.playing));
    $("next").addEventListener("click", () => this.showToss(this.toss + 1));
    $("before").addEventListener("click", () => this.showToss(Math.max(this.toss - 1, 0)));
    $("time").addEventListener("input", ({ target }) => {
      this.player.playing = false;
      this.player.seek(Number(target.value) * this.player.motion.duration_s);
    });
    $("speed").addEventListener("input", ({ target }) => {
      this.player.speed = 2 ** Number(target.value);
      $("speed-label").textContent = `${this.player.speed.toPrecision(2)} ×`;
    });
  }

  /** A launch brings its height, and the engine that can follow it. */
  launchChosen() {
    const launch = this.launches.find(({ name }) => name === form.elements.launch.value);
    if (launch.height_m !== null) form.elements.height.value = launch.height_m;
    this.labels();
  }

  /** What the sliders say, and which of them count. */
  labels() {
    const { elements } = form;
    const launch = this.launches.find(({ name }) => name === elements.launch.value);
    const flat = elements.engine.querySelector("[value=flat]");
    flat.disabled = !launch.planar;
    if (flat.disabled) elements.engine.value = "volumetric";
    const scene = coinmc.sceneOf(form, this.launches);
    const own = scene.surface === coinmc.OWN;
    for (const field of form.querySelectorAll("[data-own]")) field.hidden = !own;
    $("rolling-field").hidden = !own || scene.engine !== "volumetric";
    $("ratio-label").textContent = String(scene.ratio);
    $("radius-label").textContent = `${(scene.radius_m * 1000).toFixed(1)} mm`;
    $("restitution-label").textContent = scene.restitution.toFixed(2);
    $("friction-label").textContent = scene.friction.toFixed(2);
    $("rolling-label").textContent = `${(scene.rolling_friction_m * 1000).toFixed(2)} mm`;
    $("height-label").textContent = `${Number(elements.height.value).toFixed(2)} m`;
    $("launch-doc").textContent = launch.doc;
    return scene;
  }

  /** Another scene: everything begins anew. */
  changed() {
    this.scene = this.labels();
    this.config = coinmc.config(this.scene);
    $("config").textContent = this.config;
    this.endFair();
    $("fair-answer").textContent = "";
    $("use").hidden = true;
    const found = this.kernel.ask({ ask: "check", config: this.config });
    const problems = found.problems ?? [];
    $("problems").textContent = problems.map(({ message }) => message).join("\n");
    $("notes").textContent = (found.notes ?? []).join("\n");
    this.hold();
    if (problems.length) return;
    this.begin();
    this.showToss(0);
  }

  begin() {
    this.hold();
    const count = new coinmc.Count(this.workers, this.config, this.scene.tosses, (found) => {
      if (this.count === count) this.found(found);
    });
    this.count = count;
    $("hold").textContent = "Hold";
    count.run().catch((error) => ($("problems").textContent = error.message));
  }

  hold() {
    this.count?.stop();
    this.count = null;
    $("hold").textContent = "Toss again";
  }

  found({ tally, tosses, ms, done }) {
    if (!document.documentElement.dataset.firstTossMs) {
      document.documentElement.dataset.firstTossMs = performance.now().toFixed(0);
    }
    const question = { ask: "estimate", config: this.config, tally };
    const { faces, undecided, left, confidence } = this.kernel.ask(question);
    coinmc.showFaces($("faces"), faces, coinmc.arcRule(this.scene.ratio));
    const rate = Math.round(tosses / (ms / 1000));
    const rest = [undecided && `${undecided} undecided`, left && `${left} left the table`];
    $("counted").textContent = [
      `${coinmc.grouped(tosses)} of ${coinmc.grouped(this.scene.tosses)} tosses`,
      `${coinmc.grouped(rate)} a second on ${this.workers.length} cores`,
      ...rest.filter(Boolean),
    ].join(", ");
    $("confidence").textContent = `${confidence * 100} %`;
    $("counted").dataset.tally = JSON.stringify(tally);
    $("counted").dataset.rate = rate;
    if (!done) return;
    this.count = null;
    $("hold").textContent = "Toss again";
    const said = Object.entries(faces).map(([face, found]) => `${face} ${coinmc.written(found)}`);
    $("said").textContent = `After ${tosses} tosses: ${said.join(", ")}.`;
  }

  async showToss(toss) {
    const asked = { config: this.config, toss };
    this.toss = toss;
    this.drawer ??= new coinmc.Worker(this.module);
    try {
      const { answer } = await this.drawer.ask({ ask: "motion", ...asked, most: STATES });
      if (this.config !== asked.config || this.toss !== toss) return;
      const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
      this.player.show(answer, !still);
      this.showTime(0, !still);
      const outcome = answer.outcome.replaceAll("_", " ");
      $("outcome").textContent =
        `Toss ${toss}: ${outcome}, after ${answer.impacts} impacts and ${answer.duration_s.toFixed(2)} s.`;
      $("toss").setAttribute("aria-label", `Drawing of toss ${toss}, which ends on: ${outcome}`);
    } catch (error) {
      $("outcome").textContent = error.message;
    }
  }

  showTime(time, playing) {
    const { duration_s, states } = this.player.motion;
    $("time").value = duration_s ? time / duration_s : 0;
    const energy = coinmc.stateAt(states, time)[coinmc.ENERGY];
    $("time-label").textContent = `${time.toFixed(3)} s, ${energy.toFixed(3)} J/kg`;
    $("play").textContent = playing ? "Pause" : "Play";
  }

  findFair() {
    $("fair").textContent = "Stop";
    $("fair-answer").textContent = "Searching …";
    const failed = (error) => {
      this.endFair();
      $("fair-answer").textContent = error.message;
    };
    this.stopFair = coinmc.findFair(this.module, this.config, (found) => this.fair(found), failed);
  }

  endFair() {
    this.stopFair?.();
    this.stopFair = null;
    $("fair").textContent = "Find the fair ratio";
  }

  fair({ roots, confidence, tosses, done }) {
    const end = (x) => x?.toFixed(4) ?? "open";
    const one = ({ value, lo, hi }) => `${value.toFixed(4)} [${end(lo)}, ${end(hi)}]`;
    const answer = roots.length
      ? `H/R = ${roots.map(one).join(" and ")}, ${confidence * 100} % interval, ${coinmc.grouped(tosses)} tosses`
      : "No ratio between 0.05 and 4 makes this coin three-way fair.";
    $("fair-answer").textContent = done ? `${answer}.` : `${answer}; searching on …`;
    this.root = roots[0]?.value;
    $("use").hidden = !roots.length;
    if (done) this.endFair();
  }

  useFair() {
    form.elements.ratio.value = Math.log2(this.root);
    form.dispatchEvent(new Event("input"));
  }

  async copy() {
    try {
      await navigator.clipboard.writeText(this.config);
      $("copied").textContent = "Copied.";
    } catch {
      getSelection().selectAllChildren($("config"));
      $("copied").textContent = "Selected: copy it with Ctrl-C.";
    }
    setTimeout(() => ($("copied").textContent = ""), 3000);
  }

  save() {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([this.config], { type: "application/toml" }));
    link.download = "toss.toml";
    link.click();
    URL.revokeObjectURL(link.href);
  }
};

/** Fills a list of choices. */
function choices(select, names) {
  select.append(...names.map(([value, text]) => new Option(text, value)));
}

(async () => {
  const module = await coinmc.compile();
  const kernel = new coinmc.Kernel(await WebAssembly.instantiate(module));
  const about = kernel.ask({ ask: "about" });
  choices(form.elements.surface, about.materials.map(({ name, doc }) => [name, `${name}: ${doc}`]));
  choices(form.elements.launch, about.launches.map(({ name }) => [name, name]));
  $("version").textContent = about.version;
  coinmc.page = new coinmc.Page(module, about);
  document.body.classList.add("ready");
})().catch((error) => {
  $("problems").textContent = `The page cannot toss here: ${error.message}`;
});

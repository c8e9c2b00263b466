// The WebAssembly module: how it is loaded, asked, and put to work in Web Workers.
//
// All files are classic scripts that share the object `coinmc`, as browsers load neither modules nor
// workers from a USB stick (file://). Workers begin from a text for the same reason.
"use strict";
globalThis.coinmc ??= {};

/** A module that answers questions; docs of the questions: page/src/question.rs. */
coinmc.Kernel = class {
  /** @param {WebAssembly.Instance} instance */
  constructor(instance) {
    this.module = instance.exports;
  }

  /** The answer to a question; throws what the module says is wrong with it. */
  ask(question) {
    const { memory, coinmc_question, coinmc_answer, coinmc_answer_at } = this.module;
    const text = new TextEncoder().encode(JSON.stringify(question));
    const at = coinmc_question(text.length); // may move the memory: a view of it is made after
    new Uint8Array(memory.buffer, at, text.length).set(text);
    const length = coinmc_answer();
    const bytes = new Uint8Array(memory.buffer, coinmc_answer_at(), length);
    const answer = JSON.parse(new TextDecoder().decode(bytes));
    if (answer.error) throw new Error(answer.error);
    return answer;
  }
};

/** The compiled module: fetched from a server, or unpacked from `kernel-text.js` without one. */
coinmc.compile = async function () {
  if (location.protocol !== "file:") {
    return WebAssembly.compileStreaming(fetch("coinmc.wasm"));
  }
  await new Promise((done, failed) => {
    const script = document.createElement("script");
    script.src = "kernel-text.js"; // sets coinmc.kernelText
    script.onload = done;
    script.onerror = () => failed(new Error("kernel-text.js is missing"));
    document.head.append(script);
  });
  const bytes = Uint8Array.from(atob(coinmc.kernelText), (c) => c.charCodeAt(0));
  delete coinmc.kernelText;
  return WebAssembly.compile(bytes);
};

/** What a worker does: it receives the module, then one question after another. */
coinmc.workerText = () => `
  "use strict";
  const coinmc = {};
  coinmc.Kernel = ${coinmc.Kernel};
  let kernel;
  onmessage = ({ data }) => {
    if (data.module) {
      kernel = new coinmc.Kernel(new WebAssembly.Instance(data.module));
      return;
    }
    const begun = performance.now();
    let message;
    try {
      message = { answer: kernel.ask(data.question) };
    } catch (error) {
      message = { error: error.message };
    }
    postMessage({ ...message, id: data.id, took: performance.now() - begun });
  };`;

/** A worker with a kernel; `ask` returns a promise of { answer, took }, took in ms. */
coinmc.Worker = class {
  constructor(module) {
    const text = new Blob([coinmc.workerText()], { type: "text/javascript" });
    this.url = URL.createObjectURL(text);
    this.worker = new Worker(this.url);
    this.worker.postMessage({ module });
    this.waiting = new Map();
    this.asked = 0;
    this.worker.onmessage = ({ data }) => {
      const { done, failed } = this.waiting.get(data.id);
      this.waiting.delete(data.id);
      if (data.error) failed(new Error(data.error));
      else done(data);
    };
    this.worker.onerror = (event) => {
      for (const { failed } of this.waiting.values()) failed(new Error(event.message));
      this.waiting.clear();
    };
  }

  ask(question) {
    const id = this.asked++;
    return new Promise((done, failed) => {
      this.waiting.set(id, { done, failed });
      this.worker.postMessage({ id, question });
    });
  }

  /** Ends it, whatever it computes; its promises stay open. */
  end() {
    this.worker.terminate();
    URL.revokeObjectURL(this.url);
    this.waiting.clear();
  }
};

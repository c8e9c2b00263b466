// Elements. All text is set as text, never parsed: names and configs come from outside.

const SVG = "http://www.w3.org/2000/svg";

function fill(node, properties, children) {
  for (const [name, value] of Object.entries(properties ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "value" || name === "checked" || name === "disabled") node[name] = value;
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children.flat(Infinity)) {
    if (child !== null && child !== undefined && child !== false) node.append(child);
  }
  return node;
}

/** An element with attributes, listeners (`onclick`) and children: nodes or text. */
export function el(tag, properties, ...children) {
  return fill(document.createElement(tag), properties, children);
}

/** The same in SVG. */
export function svg(tag, properties, ...children) {
  return fill(document.createElementNS(SVG, tag), properties, children);
}

let ids = 0;

/** A name that no other element of the page has. */
export function unique(stem) {
  ids += 1;
  return `${stem}-${ids}`;
}

/** A choice with its label; `options` are pairs of value and text. */
export function choice(label, options, value, change) {
  const id = unique("choice");
  const select = el(
    "select",
    { id, onchange: () => change(select.value) },
    options.map(([key, text]) => el("option", { value: key, selected: key === value }, text)),
  );
  return el("span", { class: "control" }, el("label", { for: id }, label), select);
}

/** A slider over the values of a list, which it shows beside it. */
export function slider(label, values, at, show, change) {
  const id = unique("slider");
  const output = el("output", { for: id }, show(values[at]));
  const input = el("input", {
    id,
    type: "range",
    min: 0,
    max: values.length - 1,
    step: 1,
    value: at,
    "aria-valuetext": show(values[at]),
    oninput: () => {
      const value = values[Number(input.value)];
      output.textContent = show(value);
      input.setAttribute("aria-valuetext", show(value));
      change(Number(input.value));
    },
  });
  return el("span", { class: "control" }, el("label", { for: id }, label), input, output);
}

/** Calls back when a node changes its size, at the next frame: what is then drawn may change it again. */
export function onResize(node, callback) {
  new ResizeObserver(() => requestAnimationFrame(() => callback())).observe(node);
}

/** Hands a text to the reader as a file. */
export function download(name, type, text) {
  const address = URL.createObjectURL(new Blob([text], { type }));
  const link = el("a", { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

/** A button that copies a text, and says so. */
export function copyButton(text, what) {
  const button = el("button", { type: "button" }, `Copy ${what}`);
  const told = el("span", { role: "status", class: "faint" });
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(text);
      told.textContent = "copied";
    } catch {
      told.textContent = "not allowed here: select the text and copy it";
    }
    setTimeout(() => (told.textContent = ""), 4000);
  });
  return el("span", { class: "control" }, button, told);
}

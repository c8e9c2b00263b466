// Tables that sort by any column and can be taken along as CSV.

import { download, el } from "./dom.js";
import { grouped } from "./format.js";

/** Rows shown at a time. */
const PAGE = 50;

/**
 * A table of `columns` (name, title, doc, and `get(row)` and `show(value)`) over `length` rows. `file` is the
 * name of the CSV file.
 */
export class Table {
  constructor({ caption, columns, length, file, all }) {
    Object.assign(this, { caption, columns, length, file });
    this.all = all ?? columns;
    this.order = Array.from({ length }, (_, i) => i);
    this.sorted = null;
    this.page = 0;
    this.body = el("tbody");
    this.headRow = el("tr");
    this.foot = el("div", { class: "controls" });
    const table = el("table", {}, el("caption", { class: "hidden" }, caption), el("thead", {}, this.headRow), this.body);
    const scroll = el("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": caption }, table);
    this.node = el("div", {}, scroll, this.foot);
    this.draw();
  }

  /** Shows other columns. */
  choose(columns) {
    this.columns = columns;
    this.draw();
  }

  draw() {
    this.headRow.replaceChildren(...this.columns.map((column) => this.head(column)));
    const rows = this.order.slice(this.page * PAGE, (this.page + 1) * PAGE);
    const cell = (column, row) => el("td", {}, column.show(column.get(row)));
    this.body.replaceChildren(...rows.map((row) => el("tr", {}, this.columns.map((column) => cell(column, row)))));
    this.foot.replaceChildren(...this.footer());
  }

  head(column) {
    const way = this.sorted?.name === column.name ? this.sorted.way : 0;
    const sign = way > 0 ? " ▲" : way < 0 ? " ▼" : "";
    const button = el(
      "button",
      { type: "button", class: "link", title: column.doc, onclick: () => this.sort(column, way > 0 ? -1 : 1) },
      column.title + sign,
    );
    const sort = way > 0 ? "ascending" : way < 0 ? "descending" : null;
    return el("th", { scope: "col", "aria-sort": sort }, button);
  }

  sort(column, way) {
    this.sorted = { name: column.name, way };
    const compare = (a, b) => {
      const [x, y] = [column.get(a), column.get(b)];
      // what is missing comes last, whichever way
      if (x === null || y === null) return (x === null) - (y === null) || a - b;
      return (x < y ? -way : x > y ? way : 0) || a - b;
    };
    this.order.sort(compare);
    this.page = 0;
    this.draw();
    const again = [...this.headRow.querySelectorAll("button")][this.columns.indexOf(column)];
    again?.focus();
  }

  footer() {
    const pages = Math.ceil(this.length / PAGE);
    const go = (page, text, disabled) =>
      el("button", { type: "button", disabled, onclick: () => ((this.page = page), this.draw()) }, text);
    const where = `Rows ${grouped(this.page * PAGE + 1)} to ${grouped(Math.min(this.length, (this.page + 1) * PAGE))} of ${grouped(this.length)}`;
    return [
      pages > 1 && go(this.page - 1, "Earlier rows", this.page === 0),
      pages > 1 && go(this.page + 1, "Later rows", this.page === pages - 1),
      pages > 1 && el("span", { role: "status", class: "faint" }, where),
      this.file && el("button", { type: "button", onclick: () => this.save() }, "Download CSV"),
    ].filter(Boolean);
  }

  save() {
    download(this.file, "text/csv", this.csv());
  }

  /** All rows and columns in the order shown, numbers to the last digit. */
  csv() {
    const lines = [this.all.map(({ name }) => quoted(name))];
    for (const row of this.order) lines.push(this.all.map((column) => quoted(column.get(row))));
    return lines.map((cells) => cells.join(",") + "\n").join("");
  }
}

function quoted(value) {
  if (value === null || value === undefined) return "";
  const text = String(value);
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

// The page of one or several runs.

import { el } from "./dom.js";
import { head, pageData } from "./page.js";
import { convergenceSection } from "./report/convergence.js";
import { costSection } from "./report/cost.js";
import { dataSection } from "./report/data.js";
import { endingsSection } from "./report/endings.js";
import { fairSection } from "./report/fair.js";
import { heatSection } from "./report/heat.js";
import { Run } from "./report/model.js";
import { overview } from "./report/overview.js";
import { probabilitySection } from "./report/probability.js";
import { provenanceSection } from "./report/provenance.js";
import { publishedSection } from "./report/published.js";
import { tossesSection } from "./report/tosses.js";

function navigation(sections) {
  const links = sections.map((section) => el("a", { href: `#${section.id}` }, section.querySelector("h2").textContent));
  return el("nav", { "aria-label": "Sections" }, links);
}

const data = pageData();
const runs = data.runs.map((run, number) => new Run(run, number));
const sections = [
  probabilitySection(runs),
  heatSection(runs),
  fairSection(runs),
  publishedSection(runs),
  endingsSection(runs),
  convergenceSection(runs),
  tossesSection(runs, data.kinds),
  costSection(runs),
  dataSection(runs),
  provenanceSection(runs),
].filter(Boolean);
const page = document.getElementById("page");
page.replaceChildren(head(data.title, `Made by coinmc ${data.program}.`), overview(runs), navigation(sections), ...sections);

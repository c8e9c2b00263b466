// The page of tosses, or of a map of basins.

import { configBelow, head, pageData } from "./page.js";
import { places } from "./format.js";
import { BasinMap } from "./toss/map.js";
import { prepare, Viewer } from "./toss/viewer.js";

function showTosses(page, data) {
  const tosses = data.tosses.map((toss) => prepare(toss, data.kinds));
  const viewer = new Viewer(tosses, data.kinds, { autoplay: true });
  page.append(head(data.title, tosses.length === 1 && `${tosses[0].label}: ${tosses[0].outcome}`), viewer.node, configBelow(data));
  viewer.show(0);
}

function showMap(page, data) {
  const map = new BasinMap(data.map, data.kinds);
  const at = places(data.map.at);
  const words = `Each pixel is one toss${at ? `, at ${at}` : ""}; choose one to watch it. Nothing is random here.`;
  page.append(head(data.title, words), map.node, configBelow(data));
  map.draw();
  map.choose(map.at, false);
}

const data = pageData();
const page = document.getElementById("page");
page.replaceChildren();
if (data.page === "map") showMap(page, data);
else showTosses(page, data);

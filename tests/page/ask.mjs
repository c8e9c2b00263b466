// node ask.mjs FOLDER < QUESTIONS > ANSWERS
//
// Questions are a JSON list: {"count": CONFIG, "tosses": N, "workers": W} counts as the page does,
// {"choices": true} lists configs that the form can make, anything else goes to the module.
import { load, workers } from "./node.mjs";

const { coinmc, kernel } = await load(process.argv[2]);

async function answer(question) {
  if (question.count) return counted(question);
  if (question.choices) return configs();
  return kernel.ask(question);
}

async function counted({ count, tosses, workers: n }) {
  const shown = [];
  const counting = new coinmc.Count(workers(kernel, n), count, tosses, (found) => shown.push(found));
  await counting.run();
  return { last: shown.at(-1), early: shown[0], shown: shown.length };
}

/** A config for every surface, launch and engine. */
function configs() {
  const about = kernel.ask({ ask: "about" });
  const surfaces = [coinmc.OWN, ...about.materials.map(({ name }) => name)];
  const numbers = { radius_m: 0.01, restitution: 0.5, friction: 1, rolling_friction_m: 1e-5 };
  const ends = [{ ratio: 0.051, seed: 0, tosses: 1000 }, { ratio: 4, seed: 2 ** 32 - 1, tosses: 1e7 }];
  return surfaces.flatMap((surface) =>
    about.launches.flatMap(({ name, planar, height_m }) =>
      (planar ? ["flat", "volumetric"] : ["volumetric"]).flatMap((engine) =>
        ends.map((end, i) => {
          const height = i ? null : height_m + 0.05;
          return coinmc.config({ ...numbers, ...end, surface, launch: name, engine, height_m: height });
        }),
      ),
    ),
  );
}

let text = "";
for await (const piece of process.stdin) text += piece;
const answers = [];
for (const question of JSON.parse(text)) answers.push(await answer(question));
console.log(JSON.stringify(answers));

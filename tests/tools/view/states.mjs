// node states.mjs PAGE.html STATES.csv: runs a page's script on its record, and compares the results with the
// engine's states. A row of STATES.csv is ball, time, state, pocket, x, y, z, vx, vy, vz, wx, wy, wz, and the
// orientation w, x, y, z. Prints how many numbers were compared, how many differ in any bit, and the largest
// difference of an orientation in rad.
import {readFileSync} from "node:fs";
import vm from "node:vm";

const [, , page, states] = process.argv;
const html = readFileSync(page, "utf8");
const scripts = [...html.matchAll(/<script>([^]*?)<\/script>/g)].map((found) => found[1]);
const record = JSON.parse(/<script type="application\/json" id="shot">([^]*?)<\/script>/.exec(html)[1]);
const motion = scripts.filter((text) => text.includes("function stateAt("));
if (motion.length !== 1) throw new Error(`${motion.length} scripts of the page define stateAt`);
const context = vm.createContext({});
vm.runInContext(motion[0], context);
const {orientations, stateAt} = context.modules["motion.js"], orientation = orientations(record);

let compared = 0, differ = 0, turned = 0;
for (const line of readFileSync(states, "utf8").trim().split("\n")) {
  const [ball, t, state, pocket, ...rest] = line.split(",");
  const numbers = rest.map(Number), here = stateAt(record, Number(ball), Number(t));
  const mine = [...here.r, ...here.v, ...here.w];
  compared += mine.length + 2;
  const wrong = mine.filter((x, k) => !Object.is(x, numbers[k])).length + (here.state !== state)
    + (here.pocket !== Number(pocket));
  if (wrong > 0 && differ < 5) console.log(`differs: ${line}: ${JSON.stringify(here)}`);
  differ += wrong;
  // The angle between two orientations, from the vector part of their quotient; q and -q are the same.
  const q = orientation(Number(ball), Number(t)), p = numbers.slice(9);
  const same = Math.sign(q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3]);
  turned = Math.max(turned, 2 * Math.hypot(...q.map((x, k) => x - same * p[k])));
}
console.log(`compared ${compared} differ ${differ} turned ${turned}`);

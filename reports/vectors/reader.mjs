// Compares a solver with the right answers: node reader.mjs vectors.json 1e-9
// Put your own simulator in place of `solve`; this one knows free bodies, wheels and constant moments.
import { readFileSync } from "node:fs";

const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
const times = (matrix, v) => matrix.map((row) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
const moved = (a, b, h) => a.map((x, i) => x + h * b[i]);
const size = (v) => Math.hypot(...v);

// A quaternion follows in your own solver; the rows here are omega alone.
function solve({ body, initial, time }) {
  const [inertia, moment, rotor] = ["inertia", "moment", "rotor"].map((name) => numbers(body[name]));
  const [a, b, c] = inertia;
  const volume = cross(a, b).reduce((sum, x, i) => sum + x * c[i], 0);
  // The rows of the inverse of a symmetric matrix.
  const inverse = [cross(b, c), cross(c, a), cross(a, b)].map((row) => row.map((x) => x / volume));
  const rate = (w) => {
    const H = moved(times(inertia, w), rotor, 1);
    return times(inverse, moved(cross(H, w), moment, 1));
  };
  const at = numbers(time.times);
  const rows = [numbers(initial.omega)];
  for (let k = 1; k < at.length; k++) {
    const steps = 200;
    const h = (at[k] - at[k - 1]) / steps;
    let w = rows[k - 1];
    for (let step = 0; step < steps; step++) {
      const k1 = rate(w);
      const k2 = rate(moved(w, k1, h / 2));
      const k3 = rate(moved(w, k2, h / 2));
      const k4 = rate(moved(w, k3, h));
      w = w.map((x, i) => x + (h / 6) * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]));
    }
    rows.push(w);
  }
  return rows;
}

function numbers({ text }) {
  return text.map((entry) => (Array.isArray(entry) ? entry.map(Number) : Number(entry)));
}

const { questions } = JSON.parse(readFileSync(process.argv[2], "utf8"));
const tolerance = Number(process.argv[3]);
let [right, wrong] = [0, 0];
for (const { name, kind, question, truth } of questions) {
  if (!["free", "wheels", "moment"].includes(kind)) continue;
  const exact = (k) => ["w1", "w2", "w3"].map((column) => Number(truth.columns[column][k]));
  const off = solve(question).map((w, k) => size(moved(w, exact(k), -1)) / size(exact(k)));
  // A NaN is not within the tolerance.
  const isRight = off.every((error) => error <= tolerance);
  isRight ? right++ : wrong++;
  if (!isRight) console.log(`${name}: off by ${Math.max(...off)}`);
}
console.log(`${right} right, ${wrong} wrong, ${questions.length - right - wrong} not tried`);
process.exit(right > 0 && wrong === 0 ? 0 : 1);

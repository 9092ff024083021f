// Reader of a free rigid body for physics engines in JavaScript, and writer of its motion.
//
// It is question.py and free_body.py for scripts with_NAME.mjs, in the same words. A script calls
// answer(solve), whose solve(body, settings) returns what stepped(body, step, start) returns:
//
//     node with_rapier.mjs step=0.01 < question.json > answer.json
//
// The engine is imported in solve, so that what is wrong with it ends the script with a sentence.
//
// start() builds the engine at the initial state, and returns { advance, row }. advance() makes one step,
// row() reads the present state by body.rowFromSpace. The first row is read before any step, so that it
// shows the state that the engine really begins with. Quaternions are [x, y, z, w], as in these engines.

import { readFileSync } from "node:fs";

// Standard output belongs to the answer, whatever an engine says.
console.log = console.info = console.error;

// With the one argument `many` each line of stdin is { settings, question }, and is answered in a line.
export async function answer(solve) {
  const [words, text] = [process.argv.slice(2), readFileSync(0, "utf8")];
  if (words.length !== 1 || words[0] !== "many") {
    process.stdout.write(JSON.stringify(await answered(solve, JSON.parse(text), words)));
    return;
  }
  for (const line of text.split("\n").filter(Boolean)) {
    const { question, settings } = JSON.parse(line);
    process.stdout.write(`${JSON.stringify(await answered(solve, question, settings))}\n`);
  }
}

async function answered(solve, question, words) {
  try {
    const body = freeBody(question);
    const { rows, ...work } = await solve(body, Object.fromEntries(words.map(setting)));
    const states = body.asksStart ? rows : rows.slice(1);
    // JSON has the decimal to which the number is the nearest double.
    const columns = body.columns.map((name, i) => [name, states.map((row) => row[i])]);
    return { t: body.times, ...work, ...Object.fromEntries(columns) };
  } catch (reason) {
    return reason instanceof Unsuited ? { unsuited: reason.message } : refuse(reason);
  }
}

// The question is none for the engine or its script, which is no failure.
class Unsuited extends Error {}

function setting(argument) {
  const [name, value] = argument.split("=");
  return [name, Number.isNaN(Number(value)) ? value : Number(value)];
}

// End the script with a sentence, or with that of an error.
export function refuse(reason) {
  console.error(String(reason));
  process.exit(1);
}

// The motion by a fixed step. The propagation is done twice, and the second is timed.
export function stepped(body, step, start) {
  const counts = body.steps(step);
  const [first] = propagated(counts, start);
  const [seconds, rows] = propagated(counts, start);
  const compile_seconds = Math.max(0, first - seconds);
  return { rows, steps: counts.at(-1), seconds, compile_seconds, ...body.remark };
}

function propagated(counts, start) {
  const { advance, row } = start();
  const began = performance.now(), used = process.cpuUsage();
  const rows = [row()];
  for (let k = 1, done = 0; k < counts.length; k++) {
    for (; done < counts[k]; done++) advance();
    rows.push(row());
  }
  // The processor's time, which other programs do not make longer.
  const { user, system } = process.cpuUsage(used);
  return [Math.min((performance.now() - began) / 1000, (user + system) / 1e6), rows];
}

// Moments, omega and attitude in principal axes, as doubles: these engines store principal moments. `turn`
// leads from these axes to those of the question. A motion backwards in time is the motion forwards with
// omega reversed, and is given as that one.
function freeBody({ model, bits, columns, body, initial, time }) {
  if (model !== "euler" || "rotor" in body || "damping" in body || doubles(body.moment).some((m) => m !== 0))
    throw new Unsuited("expected a free rigid body, got a moment, wheels, damping or a fluid @ body");
  const elapsed = doubles(time.elapsed);
  const sign = elapsed.at(-1) < 0 ? -1 : 1;
  const asksStart = elapsed[0] === 0;
  const instants = [...(asksStart ? [] : [0]), ...elapsed.map(Math.abs)];
  const { moments, turn } = principal(doubles(body.inertia));
  const isTurned = turn[3] !== 1;
  const [w, x, y, z] = doubles(initial.attitude);
  const attitude = product(unit([x, y, z, w]), turn);
  const omega = toBody(turn, doubles(initial.omega)).map((rate) => sign * rate);

  return {
    ...{ moments, attitude, omega, asksStart, columns: columns.slice(1), times: time.times.hex },
    omegaInSpace: toSpace(attitude, omega),
    remark: isTurned ? { remark: "solved in principal axes, and turned back" } : {},

    // The steps to each instant. The instants are rounded to the rung, and so is the step in the engine.
    steps(step) {
      return instants.map((instant) => {
        const count = Math.round(instant / step);
        if (!(Math.abs(instant / step - count) <= 4 * 0.5 ** bits * count))
          throw new Unsuited(`expected a step that divides t = ${instant}, got ${step} @ step`);
        return count;
      });
    },

    // A row of the answer, of omega in space axes and the attitude that an engine has.
    rowFromSpace(omega, attitude) {
      const inBody = toBody(attitude, omega).map((rate) => sign * rate);
      const [x, y, z, w] = isTurned ? product(attitude, conjugate(turn)) : attitude;
      return [...(isTurned ? toSpace(turn, inBody) : inBody), w, x, y, z];
    },
  };
}

// The doubles of a number, vector or matrix: each is there as `text` and as `hex`.
function doubles(number) {
  if (Array.isArray(number)) return number.map(doubles);
  if (typeof number === "object") return doubles(number.hex);
  const parts = /^(-?)0x([0-9a-f]+)\.?([0-9a-f]*)p([+-]?\d+)$/.exec(number);
  const [, sign, whole, fraction, exponent] = parts;
  // Two factors, so that neither leaves the range of a double.
  const power = Number(exponent) - 4 * fraction.length;
  const half = Math.trunc(power / 2);
  const size = Number(`0x${whole}${fraction}`) * 2 ** half * 2 ** (power - half);
  return sign ? -size : size;
}

// Numbers of twice the precision: sums of two doubles, the second of which is what rounding the sum loses.
// Dekker, Numerische Mathematik 18 (1971); Knuth's exact sum.

const exact = (a) => [a, 0];
const opposite = ([a, b]) => [-a, -b];

function exactSum(a, b) {
  const sum = a + b;
  const part = sum - a;
  return [sum, a - (sum - part) + (b - part)];
}

function exactProduct(a, b) {
  const [product, [ah, al], [bh, bl]] = [a * b, halves(a), halves(b)];
  return [product, al * bl - (product - ah * bh - al * bh - ah * bl)];
}

// Two numbers of half the digits each, so that their products are exact.
function halves(a) {
  const scaled = (2 ** 27 + 1) * a;
  const high = scaled - (scaled - a);
  return [high, a - high];
}

function plus([a, b], [c, d]) {
  const [sum, rest] = exactSum(a, c);
  return exactSum(sum, rest + b + d);
}

function times([a, b], [c, d]) {
  const [product, rest] = exactProduct(a, c);
  return exactSum(product, rest + a * d + b * c);
}

function over(above, below) {
  const quotient = above[0] / below[0];
  const [rest] = plus(above, opposite(times(exact(quotient), below)));
  return exactSum(quotient, rest / below[0]);
}

function cross(u, v) {
  const minor = (i, j) => plus(times(u[i], v[j]), opposite(times(u[j], v[i])));
  return [minor(1, 2), minor(2, 0), minor(0, 1)];
}

// Axes.

export const vector = ([x, y, z]) => ({ x, y, z });
export const quaternion = ([x, y, z, w]) => ({ x, y, z, w });

const conjugate = ([x, y, z, w]) => [-x, -y, -z, w];

function unit(q) {
  const length = Math.hypot(...q);
  return q.map((entry) => entry / length);
}

function product([px, py, pz, pw], [qx, qy, qz, qw]) {
  return [
    pw * qx + px * qw + py * qz - pz * qy,
    pw * qy + py * qw + pz * qx - px * qz,
    pw * qz + pz * qw + px * qy - py * qx,
    pw * qw - px * qx - py * qy - pz * qz,
  ];
}

// Turn a vector from body to space axes in twice the precision, and round it once: the engine's state is
// judged. v + 2 r x (r x v + w v)/|q|^2, r = (x, y, z); the quaternion need not be unit.
function toSpace(attitude, v) {
  const [x, y, z, w] = Array.from(attitude, exact);
  const [r, given] = [[x, y, z], Array.from(v, exact)];
  const inner = cross(r, given).map((entry, k) => plus(entry, times(w, given[k])));
  const outer = cross(r, inner);
  const size = [x, y, z, w].map((entry) => times(entry, entry)).reduce(plus);
  return given.map((entry, k) => plus(entry, over(plus(outer[k], outer[k]), size))[0]);
}

// Turn a vector from space to body axes.
const toBody = (attitude, v) => toSpace(conjugate(attitude), v);

// The principal moments, and the quaternion from the principal axes to the given ones. Jacobi's method: a
// turn about an axis takes away one product of inertia. The axes keep their order as far as they can.
function principal(inertia) {
  let [tensor, turn] = [inertia, [0, 0, 0, 1]];
  // Each turn squares what is left of the products, once they are small: a few of them reach the roundoff.
  for (let turns = 0; turns < 15; turns++) {
    const sizes = [0, 1, 2].map((k) => Math.abs(tensor[(k + 1) % 3][(k + 2) % 3]));
    const k = sizes.indexOf(Math.max(...sizes));
    if (sizes[k] === 0) break;
    const [i, j] = [(k + 1) % 3, (k + 2) % 3];
    const difference = tensor[i][i] - tensor[j][j];
    const angle = difference ? Math.atan((2 * tensor[i][j]) / difference) / 2 : Math.PI / 4;
    const about = [0, 0, 0, Math.cos(angle / 2)];
    about[k] = Math.sin(angle / 2);
    turn = unit(product(turn, about));
    const columns = [0, 1, 2].map((c) => toBody(turn, inertia.map((row) => row[c])));
    tensor = [0, 1, 2].map((r) => toBody(turn, columns.map((column) => column[r])));
  }
  return { moments: tensor.map((row, i) => row[i]), turn };
}

// What acts on the rigid body of a question: moment, loads, damping, wheels, and states of one's own.
//
// It is acting.py in JavaScript, in the same words, and may be copied beside a program of one's own:
//
//     const acting = new Acting(question, () => engine.state());
//     while (acting.t !== elapsed) {
//       const h = acting.step(elapsed, longest);
//       engine.step(acting.t, h, acting.moment);
//       acting.move(h);
//     }

// The time over which a change of wheels is formed as a difference.
const MOMENTARY = 2 ** -13;
const ALIKE = "sqrt exp log sin cos tan asin acos atan atan2 sinh cosh tanh floor abs min max sign".split(" ");
const FUNCTIONS = {
  ...Object.fromEntries(ALIKE.map((name) => [name, Math[name]])),
  "+": (a, b) => a + b,
  "-": (a, b) => a - b,
  "*": (a, b) => a * b,
  "/": (a, b) => a / b,
  pi: () => Math.PI,
  norm: Math.hypot,
  power: Math.pow,
  step: (a) => (a >= 0 ? 1 : 0),
  choose: (a, b, c) => (a >= 0 ? b : c),
};

// A number, vector or matrix of the question as doubles.
export function floats(number) {
  if (Array.isArray(number)) return number.map(floats);
  if (typeof number === "object") return floats(number.hex);
  const [, sign, digits, power] = number.match(/^(-?)0x([0-9a-f]+)p([+-]\d+)$/);
  // Two factors, so that neither leaves the range of a double.
  const half = Math.trunc(power / 2);
  return (sign ? -1 : 1) * parseInt(digits, 16) * 2 ** half * 2 ** (power - half);
}

// An elapsed time by its text, a decimal or a/b.
function instant(text, missing) {
  if (text === null) return missing;
  const [above, below = 1] = text.split("/").map(Number);
  return above / below;
}

// The steps between two switches: what is between `begin` and `end`.
class Piece {
  constructor({ from, to, steps, moment, rates = [], values = [], rotor = [] }) {
    Object.assign(this, { moment, rates, taken: values, rotor, steps: steps.map(prepared) });
    this.begin = instant(from, -Infinity);
    this.end = instant(to, Infinity);
  }

  // The values of the steps at some places; `known` has the inputs by name.
  values(places, known) {
    const done = [];
    for (const { word, numbers, operands } of this.steps.slice(0, Math.max(-1, ...places) + 1)) {
      if (word === "number") done.push(...numbers);
      else if (word in FUNCTIONS) done.push(FUNCTIONS[word](...operands.map((k) => done[k]), ...numbers));
      else done.push(known[word]);
    }
    return places.map((place) => done[place]);
  }
}

// The word of a step (its name, where it is an input), its number and its operands.
function prepared([word, ...rest]) {
  if (word === "input") return { word: rest[0], numbers: [], operands: [] };
  if (word !== "number" && word !== "power") return { word, numbers: [], operands: rest };
  return { word, numbers: [floats(rest.at(-1))], operands: rest.slice(0, -2) };
}

export class Acting {
  #state; #attitude; #sign; #inertia; #constant; #wheels; #damping; #pieces; #piece; #values = {}; #moving;
  #held; #begin; #inverse; #instants; #stops; #target; #left;

  constructor({ body, initial, time, loads, states = [], instants = [] }, state) {
    this.t = 0;
    this.#state = state;
    // A quaternion and its negative are one attitude; loads read the one that goes on from the scene's.
    this.#attitude = floats(initial.attitude);
    this.#sign = floats(time.elapsed).at(-1) < 0 ? -1 : 1;
    this.#inertia = floats(body.inertia);
    this.#inverse = inverse(this.#inertia);
    this.#constant = floats(body.moment);
    this.#wheels = "rotor" in body ? floats(body.rotor) : [0, 0, 0];
    this.#damping = "damping" in body ? floats(body.damping) : 0;
    this.#pieces = (loads?.pieces ?? []).map((piece) => new Piece(piece));
    for (const { name, start } of states) if (start) this.#values[name] = floats(start);
    this.#moving = states.filter((one) => "rate" in one).map(({ name }) => name);
    this.#held = states.filter((one) => "value" in one).map(({ name }) => name);
    this.#instants = new Map(instants.map(([at, names]) => [floats(at), names]));
    this.#stops = [...this.#instants.keys(), ...this.#pieces.slice(0, -1).map(({ end }) => end)];
    this.moment = this.moment.bind(this);
    this.#arrive();
  }

  // The present states of one's own, by name.
  get own() {
    return this.#values;
  }

  // The length of the next step on the way to an instant, none longer than `longest`.
  step(until, longest) {
    this.#target = until;
    for (const stop of this.#stops)
      if ((stop - this.t) * this.#sign > 0 && (this.#target - stop) * this.#sign > 0) this.#target = stop;
    this.#left = Math.max(1, Math.ceil(Math.abs(this.#target - this.t) / longest - 1e-6));
    return (this.#target - this.t) / this.#left;
  }

  // The engine has made this step; states of one's own follow.
  move(step) {
    const after = this.#left === 1 ? this.#target : this.t + step;
    Object.assign(this.#values, this.#advanced(after - this.t));
    this.t = after;
    this.#arrive();
  }

  // The moment in body axes, of all that acts: I w' = I w x w + this.
  moment(t, state) {
    return this.#moment(t, state, this.#advanced(t - this.t));
  }

  #moment(t, state, own) {
    const omega = state.slice(0, 3);
    const momentum = applied(this.#inertia, omega);
    const moment = this.#constant.map((M, i) => M - this.#damping * momentum[i]);
    if (!this.#pieces.length) return plus(moment, cross(this.#wheels, omega));
    const known = this.#known(t, state, own);
    const loaded = plus(moment, this.#piece.values(this.#piece.moment, known));
    if (!this.#piece.rotor.length) return plus(loaded, cross(this.#wheels, omega));
    const { wheels, reaction } = this.#turning(t, known);
    return plus(plus(loaded, cross(wheels, omega)), reaction);
  }

  // Take the values that are due, all of them before any is set, and begin what begins here.
  #arrive() {
    const forwards = this.#sign > 0;
    // The engine's own numbers may change in the middle of a step.
    this.#begin = [...this.#state()];
    this.#attitude = continued(this.#state().slice(3), this.#attitude);
    for (const piece of this.#pieces)
      if (forwards ? piece.begin <= this.t && this.t < piece.end : piece.begin < this.t && this.t <= piece.end)
        this.#piece = piece;
    const due = this.#instants.get(this.t) ?? [];
    if (due.length) {
      const values = this.#piece.values(this.#piece.taken, this.#known(this.t, this.#state(), {}));
      for (const name of due) this.#values[name] = values[this.#held.indexOf(name)];
    }
  }

  // One's own continuous states a step later, by the classical method of Runge and Kutta for the body and
  // these states together.
  #advanced(step) {
    if (!this.#moving.length || !step) return {};
    const y = [...this.#begin, ...this.#moving.map((name) => this.#values[name])];
    const moved = (part, k) => y.map((entry, i) => entry + part * step * k[i]);
    const k1 = this.#rates(this.t, y), k2 = this.#rates(this.t + step / 2, moved(0.5, k1));
    const k3 = this.#rates(this.t + step / 2, moved(0.5, k2)), k4 = this.#rates(this.t + step, moved(1, k3));
    const after = y.map((entry, i) => entry + (step / 6) * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]));
    return Object.fromEntries(this.#moving.map((name, k) => [name, after[7 + k]]));
  }

  // The rates of omega, attitude and one's own continuous states.
  #rates(t, y) {
    const state = y.slice(0, 7), own = Object.fromEntries(this.#moving.map((name, k) => [name, y[7 + k]]));
    const omega = y.slice(0, 3), [p, q1, q2, q3] = y.slice(3, 7), [a, b, c] = omega.map((w) => w / 2);
    const torque = plus(cross(applied(this.#inertia, omega), omega), this.#moment(t, state, own));
    const turning = [-q1 * a - q2 * b - q3 * c, p * a + q2 * c - q3 * b];
    turning.push(p * b + q3 * a - q1 * c, p * c + q1 * b - q2 * a);
    const rates = this.#piece.values(this.#piece.rates, this.#known(t, state, own));
    return [...applied(this.#inverse, torque), ...turning, ...rates];
  }

  #known(t, state, own) {
    const attitude = continued(state.slice(3), this.#attitude);
    return { t, ...inputs([...state.slice(0, 3), ...attitude]), ...this.#values, ...own };
  }

  // The momentum of wheels whose momentum changes, and what its change does to the body.
  #turning(t, known) {
    const rates = this.#piece.values(this.#piece.rates, known);
    const at = (later) => {
      const own = Object.fromEntries(this.#moving.map((name, k) => [name, known[name] + later * rates[k]]));
      return this.#piece.values(this.#piece.rotor, { ...known, ...own, t: t + later });
    };
    const [before, after] = [at(-MOMENTARY), at(MOMENTARY)];
    return { wheels: at(0), reaction: before.map((h, i) => (h - after[i]) / (2 * MOMENTARY)) };
  }
}

// What loads may read of omega and a unit quaternion, by name.
function inputs([w1, w2, w3, q0, q1, q2, q3]) {
  return {
    ...{ w1, w2, w3, q0, q1, q2, q3 },
    ...{ r11: 1 - 2 * (q2 * q2 + q3 * q3), r12: 2 * (q1 * q2 - q0 * q3), r13: 2 * (q1 * q3 + q0 * q2) },
    ...{ r21: 2 * (q1 * q2 + q0 * q3), r22: 1 - 2 * (q1 * q1 + q3 * q3), r23: 2 * (q2 * q3 - q0 * q1) },
    ...{ r31: 2 * (q1 * q3 - q0 * q2), r32: 2 * (q2 * q3 + q0 * q1), r33: 1 - 2 * (q1 * q1 + q2 * q2) },
  };
}

// The quaternion or its negative, whichever is nearer to the one before.
function continued(attitude, before) {
  const product = attitude.reduce((sum, entry, i) => sum + entry * before[i], 0);
  return attitude.map((entry) => (product < 0 ? -entry : entry));
}

function inverse([a, b, c]) {
  const minors = [cross(b, c), cross(c, a), cross(a, b)], volume = dot(a, minors[0]);
  return [0, 1, 2].map((i) => minors.map((minor) => minor[i] / volume));
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

const applied = (matrix, vector) => matrix.map((row) => dot(row, vector));

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

const plus = (a, b) => a.map((entry, i) => entry + b[i]);

// The inverse of a moment of inertia has eight bits.
//
// Versions: Havok 1.3.14, as in @babylonjs/havok.
//
// Expected: an angular impulse of the size of a moment makes omega 1, to the rounding of float32, 6e-8.
//
// Came: an omega that is off by up to 3e-3: for the moment 3 the inverse is 171/512, for 1 it is exact.
//
// Evidence: this script; the source is not published. Every inverse that it prints is a whole number of at
// most eight bits times a power of two.
//
// To run: npm install @babylonjs/havok@1.3.14 && node havok_inertia.mjs

import { readFileSync } from "node:fs";
import HavokPhysics from "@babylonjs/havok";

const code = new URL("HavokPhysics.wasm", import.meta.resolve("@babylonjs/havok"));
const havok = await HavokPhysics({ wasmBinary: readFileSync(code) });
const [, world] = havok.HP_World_Create();
let worst = 0;
for (const moment of [1, 1.1, 1.3, 1.7, 3, 5, 7, 10, 1000.5]) {
  const [, body] = havok.HP_Body_Create();
  havok.HP_Body_SetMotionType(body, havok.MotionType.DYNAMIC);
  havok.HP_Body_SetMassProperties(body, [[0, 0, 0], 1, [moment, moment, moment], [0, 0, 0, 1]]);
  havok.HP_World_AddBody(world, body, false);
  havok.HP_Body_ApplyAngularImpulse(body, [moment, 0, 0]);
  const omega = havok.HP_Body_GetAngularVelocity(body)[1][0];
  // The value of the last of eight bits.
  const unit = 2 ** (Math.floor(Math.log2(omega / moment)) - 7);
  const bits = (omega / moment / unit).toFixed(4);
  console.log(`moment ${moment}: expected omega 1, got ${omega}, inverse ${bits} times ${unit}`);
  worst = Math.max(worst, Math.abs(omega - 1));
}
process.exit(worst > 1e-6 ? 1 : 0);

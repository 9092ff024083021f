// A free box that is spun about its middle axis never flips: there is no omega x I omega.
//
// Versions: Havok 1.3.14, as in @babylonjs/havok.
//
// Expected: with a small part about the other axes, the spin is unstable, and omega in space changes.
//
// Came: omega in space stays as it was to rounding. The moments do count for an impulse: 2, 3, 4 on the
// moments 2, 3, 4 makes omega 1, 1.002, 1.
//
// Evidence: this script; the source is not published, and HavokPhysics.d.ts of the package has no switch.
//
// To run: npm install @babylonjs/havok@1.3.14 && node havok_term.mjs

import { readFileSync } from "node:fs";
import HavokPhysics from "@babylonjs/havok";

const code = new URL("HavokPhysics.wasm", import.meta.resolve("@babylonjs/havok"));
const havok = await HavokPhysics({ wasmBinary: readFileSync(code) });
const [, world] = havok.HP_World_Create();
havok.HP_World_SetGravity(world, [0, 0, 0]);

function free(mass) {
  const [, body] = havok.HP_Body_Create();
  havok.HP_Body_SetMotionType(body, havok.MotionType.DYNAMIC);
  havok.HP_Body_SetMassProperties(body, mass);
  havok.HP_Body_SetAngularDamping(body, 0);
  havok.HP_World_AddBody(world, body, false);
  return body;
}

const pushed = free([[0, 0, 0], 1, [2, 3, 4], [0, 0, 0, 1]]);
havok.HP_Body_ApplyAngularImpulse(pushed, [2, 3, 4]);
console.log("an impulse of the moments makes omega", havok.HP_Body_GetAngularVelocity(pushed)[1]);

const [, box] = havok.HP_Shape_CreateBox([0, 0, 0], [0, 0, 0, 1], [1, 2, 3]);
const body = free(havok.HP_Shape_BuildMassProperties(box)[1]);
const start = [0.01, 3, 0.01];
havok.HP_Body_SetAngularVelocity(body, start);
let change = 0;
for (let k = 0; k < 3000; k++) {
  havok.HP_World_Step(world, 0.01);
  const omega = havok.HP_Body_GetAngularVelocity(body)[1];
  change = Math.max(change, ...omega.map((w, i) => Math.abs(w - start[i])));
}
console.log("expected omega in space changes by more than 1 in 30 s");
console.log("got     ", change);
process.exit(change < 0.1 ? 1 : 0);

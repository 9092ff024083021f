// Before 0.20.0 a free box that is spun about its middle axis never flips: there is no omega x I omega.
//
// Versions: Rapier 0.11.2 to 0.19.3, as in @dimforge/rapier3d-compat; 0.20.0 and 0.21.0 have the term.
//
// Expected: with a small part about the other axes, the spin is unstable, and omega in space changes.
//
// Came: omega in space stays as it was, and nothing in JavaScript switches the term on; from 0.20.0 on,
// nothing switches it off.
//
// Evidence: in Rust the velocity of a step is that of `angvel_with_gyroscopic_forces` where the body has
// `gyroscopic_forces_enabled`, and the old one otherwise: https://github.com/dimforge/rapier.
//
// To run: npm install @dimforge/rapier3d-compat@0.19.3 && node rapier_term.mjs

import RAPIER from "@dimforge/rapier3d-compat";

await RAPIER.init();
const world = new RAPIER.World({ x: 0, y: 0, z: 0 });
world.timestep = 0.01;
const start = { x: 0.01, y: 3, z: 0.01 };
const description = RAPIER.RigidBodyDesc.dynamic().setAngvel(start).setCanSleep(false);
const body = world.createRigidBody(description);
world.createCollider(RAPIER.ColliderDesc.cuboid(0.5, 1, 1.5), body);
let change = 0;
for (let k = 0; k < 1000; k++) {
  world.step();
  const omega = body.angvel();
  change = Math.max(change, ...["x", "y", "z"].map((axis) => Math.abs(omega[axis] - start[axis])));
}
console.log("expected omega in space changes by more than 1 in 10 s");
console.log("got     ", change, "Rapier", RAPIER.version());
process.exit(change < 0.1 ? 1 : 0);

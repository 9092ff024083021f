// A free ball spins faster with every step.
//
// Versions: Rapier 0.20.0 and 0.21.0, as in @dimforge/rapier3d-compat; not 0.19.3, which has no gyroscopic
// term.
//
// Expected: omega of a body with three equal moments is constant, to rounding that goes as the root of the
// steps.
//
// Came: omega grows in proportion to the number of substeps, by about 1e-7 of it in each: by 1 % in twenty
// seconds of 1/1024 with four iterations. The finer the step, the larger the error.
//
// Evidence: `angvel_with_gyroscopic_forces` turns omega to the axes of the body and back, in float32, where
// nothing else acts on a ball. That this is the cause is a conclusion from reading:
// https://github.com/dimforge/rapier.
//
// To run: npm install @dimforge/rapier3d-compat@0.21.0 && node rapier_spin_up.mjs

import RAPIER from "@dimforge/rapier3d-compat";

await RAPIER.init();
let growth = 0;
for (const step of [1 / 64, 1 / 256, 1 / 1024]) {
  const world = new RAPIER.World({ x: 0, y: 0, z: 0 });
  world.timestep = step;
  const description = RAPIER.RigidBodyDesc.dynamic()
    .setAngvel({ x: 0, y: 0, z: 1 })
    .setCanSleep(false)
    .setAdditionalMassProperties(
      ...[1, { x: 0, y: 0, z: 0 }, { x: 1, y: 1, z: 1 }, { x: 0, y: 0, z: 0, w: 1 }],
    );
  const body = world.createRigidBody(description);
  for (let k = 0; k < 20 / step; k++) world.step();
  growth = body.angvel().z - 1;
  console.log(`step 1/${1 / step}: expected omega 1, got ${body.angvel().z}`);
}
process.exit(Math.abs(growth) > 1e-4 ? 1 : 0);

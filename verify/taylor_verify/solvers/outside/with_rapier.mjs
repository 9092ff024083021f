// /// script
// requires-node = ">=20"
// dependencies = ["@dimforge/rapier3d-compat@0.21.0"]
// [tool.taylor-verify]
// title = "Rapier, rigid bodies in float32"
// models = ["euler"]
// rungs = ["f32"]
// loads = false
// data = "tensor"
// [tool.taylor-verify.settings]
// iterations = 4
// defaults = ["off", "shipped"]
// step = 0.01
// ///
//
// Rapier, a Rust library compiled to WebAssembly. A step has as many substeps as there are iterations. The
// JavaScript has no switch for the gyroscopic term, which is on from 0.20.0 on, and was off before. Nor can
// it lift the cap that came with 0.20.0, a turn of 45 degrees in a step. As shipped there is no damping, and
// a body may fall asleep.

import { answer, quaternion, refuse, stepped, vector } from "./free_body.mjs";

answer(async (body, settings) => {
  const { default: RAPIER } = await import("@dimforge/rapier3d-compat");
  await RAPIER.init();
  return stepped(body, settings.step, () => {
    const world = new RAPIER.World(vector([0, 0, 0]));
    world.timestep = settings.step;
    if ("numSolverIterations" in world) world.numSolverIterations = settings.iterations;
    else if (settings.iterations !== 4) refuse("this version of Rapier has no iterations @ iterations");
    const description = RAPIER.RigidBodyDesc.dynamic()
      .setRotation(quaternion(body.attitude))
      .setAngvel(vector(body.omegaInSpace))
      .setCanSleep(settings.defaults === "shipped")
      .setAdditionalMassProperties(
        ...[1, vector([0, 0, 0]), vector(body.moments), quaternion([0, 0, 0, 1])],
      );
    const spun = world.createRigidBody(description);
    return {
      advance: () => world.step(),
      row() {
        const [w, q] = [spun.angvel(), spun.rotation()];
        return body.rowFromSpace([w.x, w.y, w.z], [q.x, q.y, q.z, q.w]);
      },
    };
  });
});

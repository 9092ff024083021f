// /// script
// requires-node = ">=20"
// dependencies = ["cannon-es@0.20.0"]
// [tool.taylor-verify]
// title = "cannon-es, rigid bodies in float64"
// models = ["euler"]
// loads = false
// data = "tensor"
// [tool.taylor-verify.settings]
// defaults = ["off", "shipped"]
// step = 0.01
// ///
//
// cannon-es, written in JavaScript. It has no gyroscopic term: torques alone change omega in space axes.
// As shipped it damps omega by a hundredth in a unit of time; no body falls asleep, and there is no cap.

import { answer, stepped } from "./free_body.mjs";

answer(async (body, settings) => {
  const { Body, World } = await import("cannon-es");
  return stepped(body, settings.step, () => {
    const world = new World();
    const spun = new Body({ mass: 1 });
    if (settings.defaults === "off") spun.angularDamping = 0;
    spun.quaternion.set(...body.attitude);
    spun.angularVelocity.set(...body.omegaInSpace);
    world.addBody(spun);
    // The engine computes moments from shapes, of which this body has none.
    spun.inertia.set(...body.moments);
    spun.invInertia.set(...body.moments.map((moment) => 1 / moment));
    spun.updateInertiaWorld(true);
    return {
      advance: () => world.step(settings.step),
      row: () => body.rowFromSpace(spun.angularVelocity.toArray(), spun.quaternion.toArray()),
    };
  });
});

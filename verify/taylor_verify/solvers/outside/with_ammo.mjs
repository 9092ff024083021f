// /// script
// requires-node = ">=20"
// dependencies = ["ammojs-typed@1.1.0"]
// [tool.taylor-verify]
// title = "ammo.js, Bullet 2.82 in float32"
// models = ["euler"]
// rungs = ["f32"]
// loads = false
// data = "tensor"
// [tool.taylor-verify.settings]
// flags = ["2", "0", "4", "8"]
// build = ["javascript", "wasm"]
// defaults = ["off", "shipped"]
// step = 0.01
// ///
//
// ammo.js, Bullet compiled to JavaScript and to WebAssembly. Flag 2 is the gyroscopic term, explicit, and its
// torque is cut at 100. Flags 4 and 8, the implicit ones, came with Bullet 2.83: they have no effect here. As
// shipped there is no gyroscopic term and no damping, and a body may fall asleep.

import { answer, stepped } from "./free_body.mjs";

const DISABLE_DEACTIVATION = 4;
const BUILDS = { javascript: "ammojs-typed", wasm: "ammojs-typed/wasm" };

answer(async (body, settings) => {
  const { default: load } = await import(BUILDS[settings.build]);
  const Ammo = await load();
  return stepped(body, settings.step, () => {
    const origin = new Ammo.btVector3(0, 0, 0);
    const world = emptyWorld(Ammo);
    world.setGravity(origin);
    const start = new Ammo.btTransform(new Ammo.btQuaternion(...body.attitude), origin);
    const construction = new Ammo.btRigidBodyConstructionInfo(
      ...[1, new Ammo.btDefaultMotionState(start), new Ammo.btSphereShape(1)],
      new Ammo.btVector3(...body.moments),
    );
    const spun = new Ammo.btRigidBody(construction);
    if (settings.defaults === "off") {
      spun.setFlags(settings.flags);
      spun.setActivationState(DISABLE_DEACTIVATION);
    }
    world.addRigidBody(spun);
    spun.setAngularVelocity(new Ammo.btVector3(...body.omegaInSpace));
    return {
      // No substeps: this very step, and no interpolation.
      advance: () => world.stepSimulation(settings.step, 0),
      row() {
        const w = spun.getAngularVelocity();
        const q = spun.getWorldTransform().getRotation();
        return body.rowFromSpace([w.x(), w.y(), w.z()], [q.x(), q.y(), q.z(), q.w()]);
      },
    };
  });
});

function emptyWorld(Ammo) {
  const configuration = new Ammo.btDefaultCollisionConfiguration();
  const dispatcher = new Ammo.btCollisionDispatcher(configuration);
  const solver = new Ammo.btSequentialImpulseConstraintSolver();
  return new Ammo.btDiscreteDynamicsWorld(
    ...[dispatcher, new Ammo.btDbvtBroadphase(), solver, configuration],
  );
}

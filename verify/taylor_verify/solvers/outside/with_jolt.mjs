// /// script
// requires-node = ">=20"
// dependencies = ["jolt-physics@1.1.0"]
// [tool.taylor-verify]
// title = "Jolt Physics, rigid bodies in float32"
// models = ["euler"]
// rungs = ["f32"]
// loads = false
// data = "tensor"
// [tool.taylor-verify.settings]
// gyroscopic = ["on", "off"]
// defaults = ["off", "shipped"]
// step = 0.01
// ///
//
// Jolt Physics, a C++ library compiled to WebAssembly. As shipped it has no gyroscopic term, damps omega by
// a twentieth in a unit of time, caps it at 15 pi, and lets a body fall asleep.

import { answer, stepped } from "./free_body.mjs";

const NO_CAP = 1e18;

answer(async (body, settings) => {
  const { default: load } = await import("jolt-physics");
  const Jolt = await load();
  return stepped(body, settings.step, () => {
    const system = world(Jolt);
    system.GetPhysicsSystem().SetGravity(new Jolt.Vec3(0, 0, 0));
    const creation = new Jolt.BodyCreationSettings(
      ...[new Jolt.SphereShape(1), new Jolt.RVec3(0, 0, 0), new Jolt.Quat(...body.attitude)],
      ...[Jolt.EMotionType_Dynamic, 0],
    );
    if (settings.defaults === "off") {
      creation.mApplyGyroscopicForce = settings.gyroscopic === "on";
      creation.mAngularDamping = 0;
      creation.mMaxAngularVelocity = NO_CAP;
      creation.mAllowSleeping = false;
    }
    const bodies = system.GetPhysicsSystem().GetBodyInterface();
    const spun = bodies.CreateBody(creation);
    bodies.AddBody(spun.GetID(), Jolt.EActivation_Activate);
    const inverses = body.moments.map((moment) => 1 / moment);
    spun.GetMotionProperties().SetInverseInertia(new Jolt.Vec3(...inverses), new Jolt.Quat(0, 0, 0, 1));
    spun.SetAngularVelocity(new Jolt.Vec3(...body.omegaInSpace));
    return {
      advance: () => system.Step(settings.step, 1),
      row() {
        // Two vectors that are returned share their memory.
        const w = spun.GetAngularVelocity();
        const omega = [w.GetX(), w.GetY(), w.GetZ()];
        const q = spun.GetRotation();
        return body.rowFromSpace(omega, [q.GetX(), q.GetY(), q.GetZ(), q.GetW()]);
      },
    };
  });
});

// A world with one layer, in which nothing collides.
function world(Jolt) {
  const settings = new Jolt.JoltSettings();
  const layers = new Jolt.ObjectLayerPairFilterTable(1);
  const broad = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
  broad.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
  settings.mObjectLayerPairFilter = layers;
  settings.mBroadPhaseLayerInterface = broad;
  const filter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, layers, 1);
  settings.mObjectVsBroadPhaseLayerFilter = filter;
  return new Jolt.JoltInterface(settings);
}

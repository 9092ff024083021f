// With the gyroscopic force a free ball spins faster with every step.
//
// Versions: Jolt Physics 1.1.0, as in jolt-physics.
//
// Expected: omega of a ball is constant, to rounding that goes as the root of the steps.
//
// Came: with `mApplyGyroscopicForce` it grows in proportion to the number of steps, by about 6e-8 of it in
// each; without, it stays to the last bit. The finer the step, the larger the error.
//
// Evidence: `ApplyGyroscopicForceInternal` (Jolt/Physics/Body/MotionProperties.inl) turns omega to principal
// axes and back, in float32, where nothing else acts on a ball. That this is the cause is a conclusion from
// reading: https://github.com/jrouwe/JoltPhysics/pull/809.
//
// To run: npm install jolt-physics@1.1.0 && node jolt_spin_up.mjs

import load from "jolt-physics";

const Jolt = await load();
const settings = new Jolt.JoltSettings();
const layers = new Jolt.ObjectLayerPairFilterTable(1);
const broad = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
broad.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
settings.mObjectLayerPairFilter = layers;
settings.mBroadPhaseLayerInterface = broad;
settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(broad, 1, layers, 1);
const world = new Jolt.JoltInterface(settings);
world.GetPhysicsSystem().SetGravity(new Jolt.Vec3(0, 0, 0));
const bodies = world.GetPhysicsSystem().GetBodyInterface();
const attitude = new Jolt.Quat(...[-1, 2, 1, 3].map((each) => each / Math.sqrt(15)));

let growth = 0;
for (const gyroscopic of [false, true]) {
  for (const step of [1 / 100, 1 / 1000]) {
    const creation = new Jolt.BodyCreationSettings(
      ...[new Jolt.SphereShape(1), new Jolt.RVec3(0, 0, 0), attitude, Jolt.EMotionType_Dynamic, 0],
    );
    creation.mApplyGyroscopicForce = gyroscopic;
    creation.mAngularDamping = 0;
    creation.mAllowSleeping = false;
    const body = bodies.CreateBody(creation);
    bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
    body.SetAngularVelocity(new Jolt.Vec3(0.25, 0.75, -0.5));
    for (let k = 0; k < 20 / step; k++) world.Step(step, 1);
    const omega = body.GetAngularVelocity();
    growth = Math.hypot(omega.GetX(), omega.GetY(), omega.GetZ()) / Math.hypot(0.25, 0.75, 0.5) - 1;
    console.log(`term ${gyroscopic}, step 1/${1 / step}: expected no growth of omega, got ${growth}`);
    bodies.RemoveBody(body.GetID());
  }
}
process.exit(growth > 1e-4 ? 1 : 0);

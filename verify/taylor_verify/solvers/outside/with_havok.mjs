// /// script
// requires-node = ">=20"
// dependencies = ["@babylonjs/havok@1.3.14"]
// [tool.taylor-verify]
// title = "Havok, rigid bodies in float32"
// models = ["euler"]
// rungs = ["f32"]
// loads = false
// data = "tensor"
// [tool.taylor-verify.settings]
// defaults = ["off", "shipped"]
// step = 0.01
// ///
//
// Havok, as Babylon.js has it: compiled to WebAssembly, its source not published. It has no gyroscopic term,
// so omega in space axes does not change. As shipped it damps omega by a tenth in a unit of time, caps it at
// 100, and lets a body fall asleep. It is given moments for a mass of 1.

import { readFileSync } from "node:fs";
import { answer, stepped } from "./free_body.mjs";

const NO_CAP = 1e18;

answer(async (body, settings) => {
  const { default: load } = await import("@babylonjs/havok");
  // It would fetch its code, which node does not do from a file.
  const code = new URL("HavokPhysics.wasm", import.meta.resolve("@babylonjs/havok"));
  const havok = await load({ wasmBinary: readFileSync(code) });
  return stepped(body, settings.step, () => {
    const [, world] = havok.HP_World_Create();
    const [, spun] = havok.HP_Body_Create();
    havok.HP_World_SetGravity(world, [0, 0, 0]);
    havok.HP_Body_SetMotionType(spun, havok.MotionType.DYNAMIC);
    havok.HP_Body_SetMassProperties(spun, [[0, 0, 0], 1, body.moments, [0, 0, 0, 1]]);
    havok.HP_Body_SetQTransform(spun, [[0, 0, 0], body.attitude]);
    if (settings.defaults === "off") {
      havok.HP_Body_SetAngularDamping(spun, 0);
      havok.HP_Body_SetActivationControl(spun, havok.ActivationControl.ALWAYS_ACTIVE);
      // The cap can be set from 1.3.3 on, and the step that is tuned for from 1.1.0 on.
      havok.HP_World_SetSpeedLimit?.(world, NO_CAP, NO_CAP);
      havok.HP_World_SetIdealStepTime?.(world, settings.step);
    }
    havok.HP_World_AddBody(world, spun, false);
    havok.HP_Body_SetAngularVelocity(spun, body.omegaInSpace);
    return {
      advance: () => havok.HP_World_Step(world, settings.step),
      row() {
        const [, omega] = havok.HP_Body_GetAngularVelocity(spun);
        const [, attitude] = havok.HP_Body_GetOrientation(spun);
        return body.rowFromSpace(omega, attitude);
      },
    };
  });
});

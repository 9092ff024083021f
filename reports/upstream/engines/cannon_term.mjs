// A free box that is spun about its middle axis never flips: there is no omega x I omega.
//
// Versions: cannon-es 0.20.0.
//
// Expected: with a small part about the other axes, the spin is unstable, and omega in space changes.
//
// Came: omega in space stays as it was to the last bit, whatever the moments are.
//
// Evidence: `Body.integrate` adds to omega the time step times the inverse inertia in space times the
// torque, and nothing else (dist/cannon-es.js of the package): https://github.com/pmndrs/cannon-es.
//
// To run: npm install cannon-es@0.20.0 && node cannon_term.mjs

import { Body, Box, Vec3, World } from "cannon-es";

const world = new World();
const body = new Body({ mass: 12, shape: new Box(new Vec3(0.5, 1, 1.5)), angularDamping: 0 });
world.addBody(body);
const start = [0.01, 3, 0.01];
body.angularVelocity.set(...start);
let change = 0;
for (let k = 0; k < 3000; k++) {
  world.step(0.01);
  change = Math.max(change, ...body.angularVelocity.toArray().map((w, i) => Math.abs(w - start[i])));
}
console.log("moments ", body.inertia.toArray());
console.log("expected omega in space changes by more than 1 in 30 s");
console.log("got     ", change);
process.exit(change < 0.1 ? 1 : 0);

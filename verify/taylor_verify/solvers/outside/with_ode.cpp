// /// script
// dependencies = ["libode-dev=2:0.16.2-1", "libode8=2:0.16.2-1", "libccd2=2.1-2+b1"]
// [tool.taylor-verify]
// title = "ODE, its C++ library"
// alike = ["libode8"]
// models = ["euler"]
// loads = "written"
// data = "tensor"
// flags = "-lode"
// [tool.taylor-verify.settings]
// method = ["step", "quick"]
// rotation = ["infinitesimal", "finite"]
// gyroscopic = ["on", "off"]
// defaults = ["off", "shipped"]
// step = 0.01
// ///
//
// A body of the Open Dynamics Engine in doubles, by dWorldStep or dWorldQuickStep. It takes a full tensor, has
// omega in space axes and the quaternion scalar first. As it comes there is no damping and no sleep.

#include <ode/ode.h>

#include <cstring>

namespace {
dWorldID world;
dBodyID body;
double step_length;
bool is_quick;

bool has(const char *settings, const char *word) { return std::strstr(settings, word); }
}  // namespace

extern "C" {
int takes_moments = 0;

void begin(const double *inertia, const double *omega, const double *q, double step, const char *settings) {
  if (world) dWorldDestroy(world);
  dInitODE2(0);
  world = dWorldCreate();
  body = dBodyCreate(world);
  dMass mass;
  dMassSetParameters(&mass, 1, 0, 0, 0, inertia[0], inertia[4], inertia[8], inertia[1], inertia[2], inertia[5]);
  dBodySetMass(body, &mass);
  dBodySetQuaternion(body, q);
  dBodySetAngularVel(body, omega[0], omega[1], omega[2]);
  dBodySetFiniteRotationMode(body, has(settings, "rotation=finite"));
  dBodySetGyroscopicMode(body, has(settings, "gyroscopic=on"));
  if (has(settings, "defaults=off")) dBodySetAutoDisableFlag(body, 0);
  is_quick = has(settings, "method=quick");
  step_length = step;
}

void push(const double *torque) { dBodyAddTorque(body, torque[0], torque[1], torque[2]); }

void advance() { is_quick ? dWorldQuickStep(world, step_length) : dWorldStep(world, step_length); }

void state(double *row) {
  std::memcpy(row, dBodyGetAngularVel(body), 3 * sizeof *row);
  std::memcpy(row + 3, dBodyGetQuaternion(body), 4 * sizeof *row);
}
}

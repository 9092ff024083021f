// /// script
// dependencies = ["libbullet-dev=3.24+dfsg-2", "libbullet3.24=3.24+dfsg-2"]
// [tool.taylor-verify]
// title = "Bullet, its C++ library"
// alike = ["libbullet3.24"]
// models = ["euler"]
// loads = "written"
// data = "tensor"
// flags = """-DBT_USE_DOUBLE_PRECISION -isystem{root}/usr/include/bullet
//   -lBulletDynamics-float64 -lBulletCollision-float64 -lLinearMath-float64"""
// [tool.taylor-verify.settings]
// gyroscopic = ["implicit-body", "implicit-world", "explicit", "off"]
// defaults = ["off", "shipped"]
// step = 0.01
// ///
//
// A btRigidBody in doubles, with each of Bullet's four treatments of the gyroscopic torque; the first one is
// what it ships with. It takes principal moments. There is no damping as it comes; defaults=off switches
// sleep off. A turn of more than an eighth of a circle in one step is cut short either way.

#include <btBulletDynamicsCommon.h>
#include <cstring>
#include <memory>

namespace {
std::unique_ptr<btDefaultCollisionConfiguration> configuration;
std::unique_ptr<btCollisionDispatcher> dispatcher;
std::unique_ptr<btDbvtBroadphase> broadphase;
std::unique_ptr<btSequentialImpulseConstraintSolver> solver;
std::unique_ptr<btDiscreteDynamicsWorld> world;
std::unique_ptr<btRigidBody> body;
double step_length;

int flags(const char *settings) {
  if (std::strstr(settings, "implicit-world")) return BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD;
  if (std::strstr(settings, "explicit")) return BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT;
  return std::strstr(settings, "gyroscopic=off") ? 0 : BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY;
}
}  // namespace

extern "C" {
int takes_moments = 1;

void begin(const double *inertia, const double *omega, const double *q, double step, const char *settings) {
  if (world) world->removeRigidBody(body.get());
  configuration.reset(new btDefaultCollisionConfiguration());
  dispatcher.reset(new btCollisionDispatcher(configuration.get()));
  broadphase.reset(new btDbvtBroadphase());
  solver.reset(new btSequentialImpulseConstraintSolver());
  world.reset(new btDiscreteDynamicsWorld(dispatcher.get(), broadphase.get(), solver.get(), configuration.get()));
  world->setGravity(btVector3(0, 0, 0));
  static btEmptyShape nothing;
  body.reset(new btRigidBody(1, nullptr, &nothing, btVector3(inertia[0], inertia[4], inertia[8])));
  body->setWorldTransform(btTransform(btQuaternion(q[1], q[2], q[3], q[0])));
  body->setInterpolationWorldTransform(body->getWorldTransform());
  body->updateInertiaTensor();
  body->setAngularVelocity(btVector3(omega[0], omega[1], omega[2]));
  body->setFlags(flags(settings));
  if (std::strstr(settings, "defaults=off")) body->setActivationState(DISABLE_DEACTIVATION);
  world->addRigidBody(body.get());
  step_length = step;
}

void push(const double *torque) { body->applyTorque(btVector3(torque[0], torque[1], torque[2])); }

// No substeps: the step is that of the engine.
void advance() { world->stepSimulation(step_length, 0); }

void state(double *row) {
  const btVector3 omega = body->getAngularVelocity();
  const btQuaternion q = body->getOrientation();
  const double values[] = {omega.x(), omega.y(), omega.z(), q.w(), q.x(), q.y(), q.z()};
  std::memcpy(row, values, sizeof values);
}
}

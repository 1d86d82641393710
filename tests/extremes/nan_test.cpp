// A transform that is not a number. The body that has it is lost, and Bullet takes it out of the simulation;
// all other bodies, also those that touched it, go on as if it were not there.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "plugin/capture_log.hpp"
#include "watched_world.hpp"

namespace innersphere::test {
namespace {

constexpr btScalar kNan = std::numeric_limits<btScalar>::quiet_NaN();
constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();

void breakPlace(btRigidBody& body) {
  btTransform t = body.getWorldTransform();
  t.getOrigin().setY(kNan);
  body.setWorldTransform(t);
}

void breakEverything(btRigidBody& body) {
  btTransform t;
  t.setOrigin(btVector3(kNan, kNan, kNan));
  t.getBasis().setValue(kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan);
  body.setCenterOfMassTransform(t);
}

void breakRotation(btRigidBody& body) {
  btTransform t = body.getWorldTransform();
  t.getBasis()[1][2] = kNan;
  body.setWorldTransform(t);
}

void sendToInfinity(btRigidBody& body) {
  btTransform t = body.getWorldTransform();
  t.getOrigin().setX(kInfinity);
  body.setWorldTransform(t);
}

struct Break {
  const char* name;
  void (*apply)(btRigidBody& body);
};

class NotANumber : public testing::TestWithParam<std::tuple<Break, Response, DispatcherKind>> {};

TEST_P(NotANumber, StaysWithItsBody) {
  const auto& [broken, response, kind] = GetParam();
  const CaptureLog log;
  ContactOptions options;
  options.response = response;
  options.damping = 1;
  WatchedWorld world(options, kind);
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, 4));
  world.add(shape, 1, btVector3(0, 0, btScalar(0.5)));
  btRigidBody& lost = world.add(shape, 1, btVector3(0, 0, btScalar(1.5)));
  world.add(shape, 1, btVector3(0, 0, btScalar(2.5)));
  world.add(shape, 1, btVector3(btScalar(1.0), 0, btScalar(0.5)));
  world.watch(0.5, 1.0 / 240);
  ASSERT_GT(world.contactCount(), 0);
  broken.apply(lost);
  world.watch(3, 1.0 / 240);
  for (const auto& body : world.bodies) {
    if (body.get() == &lost) continue;
    EXPECT_TRUE(isFinite(*body));
    EXPECT_LT(body->getLinearVelocity().length(), 0.1);
  }
  // The highest one falls on the lowest. Penalty forces rest deeper.
  const double depth = response == Response::penalty ? 0.02 : 0.005;
  EXPECT_NEAR(world.bodies[1]->getWorldTransform().getOrigin().z(), 0.5, depth);
  EXPECT_NEAR(world.bodies[3]->getWorldTransform().getOrigin().z(), 1.5, 2 * depth);
}

std::string caseName(const testing::TestParamInfo<NotANumber::ParamType>& info) {
  const auto& [broken, response, kind] = info.param;
  static const char* const kResponses[] = {"compliant", "rigid", "penalty"};
  return std::string(broken.name) + "_" + kResponses[static_cast<int>(response)] +
         (kind == DispatcherKind::batched ? "_batched" : "");
}

constexpr Break kBreaks[] = {{"place", breakPlace},
                             {"everything", breakEverything},
                             {"rotation", breakRotation},
                             {"infinity", sendToInfinity}};

INSTANTIATE_TEST_SUITE_P(In, NotANumber,
                         testing::Combine(testing::ValuesIn(kBreaks),
                                          testing::Values(Response::compliant, Response::rigid,
                                                          Response::penalty),
                                          testing::Values(DispatcherKind::plain, DispatcherKind::batched)),
                         caseName);

}  // namespace
}  // namespace innersphere::test

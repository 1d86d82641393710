// Options that shapes have of their own.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "innersphere/error.hpp"
#include "test_packings.hpp"
#include "test_world.hpp"

namespace innersphere::test {
namespace {

ContactOptions optionsWith(Response response, double stiffness = 0, double damping = 1, double accuracy = 0) {
  ContactOptions options;
  options.response = response;
  options.stiffness = stiffness;
  options.damping = damping;
  options.accuracy = accuracy;
  return options;
}

TEST(OptionRules, TheWorldDecidesWhereNobodyElseDoes) {
  const ContactOptions world = optionsWith(Response::penalty, 700, 0.3, 0.02);
  const ContactOptions pair = combine(world, nullptr, nullptr);
  EXPECT_EQ(pair.response, Response::penalty);
  EXPECT_EQ(pair.stiffness, 700);
  EXPECT_EQ(pair.damping, 0.3);
  EXPECT_EQ(pair.accuracy, 0.02);
}

TEST(OptionRules, OneShapeDecidesAloneButForTheQuery) {
  ContactOptions world = optionsWith(Response::penalty, 700, 0.3, 0.02);
  world.backend = Backend::cpu;
  world.estimator = Estimator::raw;
  ContactOptions own = optionsWith(Response::rigid, 40, 2, 0.5);
  own.backend = Backend::cuda;
  own.estimator = Estimator::volume_true;
  for (const ContactOptions& pair : {combine(world, &own, nullptr), combine(world, nullptr, &own)}) {
    EXPECT_EQ(pair.response, Response::rigid);
    EXPECT_EQ(pair.stiffness, 40);
    EXPECT_EQ(pair.damping, 2);
    EXPECT_EQ(pair.accuracy, 0.5);
    EXPECT_EQ(pair.backend, Backend::cpu);
    EXPECT_EQ(pair.estimator, Estimator::raw);
  }
}

TEST(OptionRules, OfTwoResponses) {
  using R = Response;
  const R expected[][3] = {
      {R::compliant, R::compliant, R::compliant}, {R::rigid, R::rigid, R::rigid},
      {R::penalty, R::penalty, R::penalty},       {R::compliant, R::rigid, R::compliant},
      {R::penalty, R::rigid, R::penalty},         {R::compliant, R::penalty, R::compliant}};
  for (const auto& [a, b, both] : expected) {
    const ContactOptions of_a = optionsWith(a), of_b = optionsWith(b);
    EXPECT_EQ(combine({}, &of_a, &of_b).response, both);
    EXPECT_EQ(combine({}, &of_b, &of_a).response, both);
  }
}

TEST(OptionRules, SpringsAreInSeriesAndTheSofterOneDamps) {
  const auto expectPair = [](const ContactOptions& a, const ContactOptions& b, double stiffness,
                             double damping) {
    for (const ContactOptions& pair : {combine({}, &a, &b), combine({}, &b, &a)}) {
      EXPECT_NEAR(pair.stiffness, stiffness, 1e-12 * stiffness);
      EXPECT_NEAR(pair.damping, damping, 1e-12);
    }
  };
  const Response c = Response::compliant, r = Response::rigid;
  expectPair(optionsWith(c, 300, 1), optionsWith(c, 600, 4), 200, 2);  // weights 2 and 1
  expectPair(optionsWith(c, 500, 1), optionsWith(c, 500, 0), 250, 0.5);
  expectPair(optionsWith(c, 500, 0.2), optionsWith(c, 0, 3), 500, 0.2);
  expectPair(optionsWith(c, 500, 0.2), optionsWith(r, 10, 3), 500, 0.2);  // a rigid one has no stiffness
  expectPair(optionsWith(c, 0, 1), optionsWith(c, 0, 3), 0, 2);
  expectPair(optionsWith(c, 1e-310, 1), optionsWith(c, 1e308, 3), 1e-310, 1);
  expectPair(optionsWith(c, 1e308, 1), optionsWith(c, 1e308, 3), 5e307, 2);
}

TEST(OptionRules, TheFinerAccuracyWins) {
  const auto accuracyOf = [](double a, double b) {
    const ContactOptions of_a = optionsWith(Response::compliant, 0, 1, a);
    const ContactOptions of_b = optionsWith(Response::compliant, 0, 1, b);
    return combine(optionsWith(Response::compliant, 0, 1, 0.001), &of_a, &of_b).accuracy;
  };
  EXPECT_EQ(accuracyOf(0.1, 0.02), 0.02);
  EXPECT_EQ(accuracyOf(0.02, 0.1), 0.02);
  EXPECT_EQ(accuracyOf(0, 0.1), 0);  // all spheres
}

TEST(ShapeOptions, AreCheckedAndCanBeTakenBack) {
  const auto shape = makeShape(latticeBox({1, 1, 1}, 2));
  EXPECT_EQ(shape->contactOptions(), nullptr);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ContactOptions& bad :
       {optionsWith(Response::rigid, -1), optionsWith(Response::rigid, 0, nan),
        optionsWith(Response::rigid, 0, 1, std::numeric_limits<double>::infinity())}) {
    try {
      shape->setContactOptions(bad);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
    }
    EXPECT_EQ(shape->contactOptions(), nullptr);
  }
  shape->setContactOptions(optionsWith(Response::rigid, 7));
  ASSERT_NE(shape->contactOptions(), nullptr);
  EXPECT_EQ(shape->contactOptions()->stiffness, 7);
  shape->resetContactOptions();
  EXPECT_EQ(shape->contactOptions(), nullptr);
}

struct Case {
  const char* name;
  ContactOptions own;   ///< of both packings
  ContactOptions pair;  ///< what that comes to for two of them; against the floor `own` holds
};

std::vector<Case> cases() {
  return {
      {"stiffness", optionsWith(Response::compliant, 4000, 0.5), optionsWith(Response::compliant, 2000, 0.5)},
      {"rigid", optionsWith(Response::rigid), optionsWith(Response::rigid)},
      {"penalty", optionsWith(Response::penalty, 8000), optionsWith(Response::penalty, 4000)},
      {"accuracy", optionsWith(Response::compliant, 0, 1, 0.3), optionsWith(Response::compliant, 0, 1, 0.3)}};
}

class ShapeOptionsIn : public testing::TestWithParam<DispatcherKind> {};

/// A world whose shapes have options moves as one in which they are the dispatcher's, bit for bit.
TEST_P(ShapeOptionsIn, AreThoseOfAWorldThatHasThem) {
  for (const Case& c : cases()) {
    for (const bool on_packing : {false, true}) {
      const auto motionOf = [&](const ContactOptions& world_options, const ContactOptions* own) {
        TestWorld world(world_options, GetParam());
        const auto shape = makeShape(latticeBox({1, 1, 1}, 6)), ground = makeShape(latticeBox({3, 3, 2}, 6));
        if (own != nullptr) {
          shape->setContactOptions(*own);
          ground->setContactOptions(*own);
        }
        if (on_packing) {
          world.add(ground, 0, btVector3(0, 0, -1));
        } else {
          world.addFloor();
        }
        world.add(shape, 1, btVector3(0, 0, btScalar(0.52)));
        world.run(0.5);
        return world.motion();
      };
      const std::vector<btScalar> expected = motionOf(on_packing ? c.pair : c.own, nullptr);
      EXPECT_EQ(motionOf({}, &c.own), expected) << c.name << " " << on_packing;
      if (std::string(c.name) != "accuracy") {
        EXPECT_NE(motionOf({}, nullptr), expected) << c.name;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Dispatchers, ShapeOptionsIn,
                         testing::Values(DispatcherKind::plain, DispatcherKind::multithreaded,
                                         DispatcherKind::batched),
                         [](const auto& info) { return nameOf(info.param); });

/// The 64 lowest spheres of the cube carry it: at a depth d they share 64 pi d^2 (3 r - d) / 3 with the
/// floor, r = 1/16, which is the weight over the stiffness at 0.045 and at 0.013 m.
TEST(ShapeOptions, CanChangeWhileABodyRests) {
  const auto expected = [](double stiffness) {
    double low = 0, high = 1.0 / 16;
    while (high - low > 1e-9) {
      const double d = (low + high) / 2;
      (64 * M_PI * d * d * (3.0 / 16 - d) / 3 > 9.81 / stiffness ? high : low) = d;
    }
    return 0.5 - low;
  };
  for (const bool as_child : {false, true}) {
    TestWorld world;
    world.addFloor();
    const auto packing = makeShape(latticeBox({1, 1, 1}, 8));
    std::shared_ptr<btCollisionShape> shape = packing;
    if (as_child) {
      auto compound = std::make_shared<btCompoundShape>();
      compound->addChildShape(btTransform::getIdentity(), packing.get());
      shape = compound;
    }
    btRigidBody& body = world.add(shape, 1, btVector3(0, 0, btScalar(0.5)));
    body.setActivationState(DISABLE_DEACTIVATION);
    const auto restsAt = [&] {
      world.run(2);
      return double(body.getWorldTransform().getOrigin().z());
    };
    EXPECT_NEAR(restsAt(), 0.5, 0.002);
    packing->setContactOptions(optionsWith(Response::compliant, 500));
    EXPECT_NEAR(restsAt(), expected(500), 0.002);
    packing->setContactOptions(optionsWith(Response::compliant, 5000));
    EXPECT_NEAR(restsAt(), expected(5000), 0.002);
    packing->resetContactOptions();
    EXPECT_NEAR(restsAt(), 0.5, 0.002);
  }
}

/// One body alone: a shape of its own from the same model.
TEST(ShapeOptions, HoldForOneBodyOnly) {
  TestWorld world;
  world.addFloor();
  const auto shape = makeShape(latticeBox({1, 1, 1}, 8));
  const auto model = std::shared_ptr<const CollisionModel>(shape, &shape->model());
  const auto soft = std::make_shared<PackingShape>(model);
  soft->setContactOptions(optionsWith(Response::compliant, 500));
  btRigidBody& stiff_body = world.add(shape, 1, btVector3(0, 0, btScalar(0.5)));
  btRigidBody& soft_body = world.add(soft, 1, btVector3(3, 0, btScalar(0.5)));
  world.run(2);
  EXPECT_NEAR(stiff_body.getWorldTransform().getOrigin().z(), 0.5, 0.002);
  EXPECT_LT(soft_body.getWorldTransform().getOrigin().z(), 0.49);
}

}  // namespace
}  // namespace innersphere::test

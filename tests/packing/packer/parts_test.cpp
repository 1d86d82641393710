// The packer's tools by themselves, against brute force.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "analytic_solids.hpp"
#include "mesh/triangle.hpp"
#include "packer/ball_tree.hpp"
#include "packer/cell_search.hpp"
#include "packer/cells.hpp"
#include "packer/container.hpp"
#include "packer/dual_simplex.hpp"
#include "packer/near_balls.hpp"
#include "packer/prism.hpp"
#include "packer/sphere_grid.hpp"

namespace innersphere::test {
namespace {

// Balls of all sizes, some of them in one place, and a moved copy of them: against all pairs.
TEST(BallTree, FindAllPairsThatMeet) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto point = [&] { return Point(unit(random), unit(random), unit(random)); };
  for (const std::size_t count : {1, 2, 5, 300}) {
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < count; ++i) {
      const Point centre = i % 7 == 6 ? balls.back().centre : point();
      balls.push_back({centre, 0.2 * std::pow(unit(random), 4)});
    }
    const BallTree tree(balls);
    for (int round = 0; round < 20; ++round) {
      Pose pose;
      pose.rotation = Eigen::AngleAxisd(3 * unit(random), (point() - Point::Constant(0.5)).normalized())
                          .toRotationMatrix();
      pose.shift = point() - pose.rotation * point();
      std::set<std::pair<std::size_t, std::size_t>> expected, found;
      for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = 0; j < count; ++j) {
          const double apart = (pose.apply(balls[i].centre) - balls[j].centre).norm();
          if (apart < balls[i].radius + balls[j].radius) expected.emplace(i, j);
        }
      }
      tree.forMeeting(pose, [&](std::size_t i, std::size_t j, const Point& way, double distance) {
        EXPECT_TRUE(found.emplace(i, j).second) << i << " and " << j << " twice";
        EXPECT_NEAR((pose.apply(balls[i].centre) - balls[j].centre - way).norm(), 0, 1e-12);
        EXPECT_NEAR(way.norm(), distance, 1e-12);
      });
      EXPECT_EQ(found, expected) << count << " balls, round " << round;
    }
  }
}

TEST(DualSimplex, EqualsADenseSearch) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr double kRounding = 1e-6;  // of the functions
  for (int round = 0; round < 30; ++round) {
    DualSimplex program;
    program.restart(0.5);
    std::vector<std::pair<double, Point>> functions;
    for (int k = 0; k < 2 + round % 9; ++k) {
      const Point gradient = Point(unit(random), unit(random), unit(random)).normalized();
      functions.emplace_back(0.3 * unit(random), gradient);
      program.add(functions.back().first, gradient);
    }
    const auto smallest = [&](const Point& y) {
      double least = 1e30;
      for (const auto& [value, gradient] : functions) least = std::min(least, value + gradient.dot(y));
      return least;
    };
    EXPECT_NEAR(smallest(program.argmax()), program.optimum(), kRounding);
    EXPECT_LE(program.argmax().cwiseAbs().maxCoeff(), 0.5 + 1e-12);
    const int n = 40;
    for (int i = 0; i <= n * n * n; ++i) {
      const Point y = Point(i % n, i / n % n, i / n / n) / n - Point::Constant(0.5);
      ASSERT_LE(smallest(y), program.optimum() + kRounding);
    }
    // The weights prove the optimum: their mix of the functions is nowhere larger.
    double value = 0, sum = 0;
    Point gradient = Point::Zero();
    program.forWeights([&](int k, double weight) {
      value += weight * functions[k].first;
      gradient += weight * functions[k].second;
      sum += weight;
    });
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(value + 0.5 * gradient.cwiseAbs().sum(), program.optimum(), kRounding);
  }
}

TEST(SphereGrid, FindsTheNearestBall) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Ball> balls;
  for (int i = 0; i < 3000; ++i) {
    // Some lie outside of the unit cube, some are smaller than the finest cells.
    const Point centre = Point(unit(random), unit(random), unit(random)) * 1.2 - Point::Constant(0.1);
    balls.push_back({centre, std::pow(unit(random), 12) * 0.4});
  }
  const SphereGrid grid(balls);
  for (int i = 0; i < 2000; ++i) {
    const Point x(unit(random), unit(random), unit(random));
    double least = 1e30;
    for (const Ball& ball : balls) least = std::min(least, ball.distance(x));
    const SphereGrid::Nearest hit = grid.nearest(x, least + 0.01);
    EXPECT_EQ(hit.distance, least);
    EXPECT_EQ(balls[hit.index].distance(x), least);
    EXPECT_EQ(grid.nearest(x, least).distance, std::numeric_limits<double>::infinity());
  }
}

// Between mirrored balls, two are equally near but for the last digit. A candidate that one of them overlaps
// by a digit would be refused, and found again in each turn of its round, without end.
TEST(CellSearch, CandidatesOverlapNoPlacedBallByADigit) {
  const TestBall solid;
  const Container container(solid);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 200; ++round) {
    std::vector<Ball> balls;
    for (int pair = 0; pair < 3; ++pair) {
      const Ball ball{Point(unit(random), unit(random), unit(random)), 0.05 + 0.1 * unit(random)};
      const Point mirrored(1 - ball.centre[0], ball.centre[1], ball.centre[2]);
      balls.push_back(ball);
      balls.push_back({mirrored, std::nextafter(ball.radius, unit(random) < 0.5 ? 0.0 : 1.0)});
    }
    const SphereGrid placed(balls);
    const std::vector<Cell> all(1);
    const CellSearch::Result found = CellSearch(container, placed, 1, 0.15, 0.1, 8).search(all);
    for (const CellSearch::Candidate& candidate : found.candidates) {
      for (const Ball& ball : balls) EXPECT_GE(ball.distance(candidate.ball.centre), candidate.ball.radius);
    }
  }
}

TEST(NearBalls, AreThoseOfAllBalls) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Ball> balls;
  for (int i = 0; i < 500; ++i) {
    // All on one side, so that most points are far from them, and some twice.
    const Point centre(unit(random) * 0.2, unit(random), unit(random));
    balls.push_back(i % 10 == 9 ? balls.back() : Ball{centre, std::pow(unit(random), 12) * 0.1});
  }
  std::vector<Point> points(5000);
  for (Point& x : points) x = Point(unit(random), unit(random), std::pow(unit(random), 4));
  const std::vector<NearBalls::Nearest> hits = nearestBalls(points, balls);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint32_t first = 0;
    for (std::uint32_t k = 1; k < balls.size(); ++k) {
      if (balls[k].distance(points[i]) < balls[first].distance(points[i])) first = k;
    }
    EXPECT_EQ(hits[i].index, first);
    EXPECT_EQ(hits[i].distance, balls[first].distance(points[i]));
  }
}

TEST(Prism, BoundsTheDistanceFromItsTriangle) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Point(unit(random), unit(random), unit(random)); };
  for (int trial = 0; trial < 200; ++trial) {
    const std::array<Point, 3> corners{point(), point(), point()};
    const Point cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (cross.norm() < 0.01) continue;
    const Point inwards = (trial % 2 ? 1 : -1) * cross.normalized();
    const Prism prism(corners, inwards);
    const auto world = [](const Point& x) { return Vec3d{x[0], x[1], x[2]}; };
    const Triangle triangle(world(corners[0]), world(corners[1]), world(corners[2]));
    const Point centre = point();
    CornerValues distances;
    const double half = 0.5, behind = prism.farthestBehind(cornersOf(centre, half), distances);
    const auto distance = [&](const Point& x) {
      prism.farthestBehind(cornersOf(x, 0), distances);
      return distances[0];
    };
    for (int corner = 0; corner < 8; ++corner) {
      const Point x = cornersOf(centre, half).row(corner).matrix();
      prism.farthestBehind(cornersOf(centre, half), distances);
      const double of_cube = distances[corner];
      EXPECT_EQ(distance(x), of_cube);
    }
    for (int i = 0; i < 50; ++i) {
      const Point x = centre + half * point(), y = centre + half * point();
      Vec3d nearest;
      const double away = std::sqrt(triangle.closest(world(x), nearest));
      // In front, nothing is nearer than the triangle itself; behind, the cube ends.
      const bool front = inwards.dot(x - corners[0]) > 0;
      EXPECT_LE(away, (front ? distance(x) : behind) + 1e-9);
      if (front) {
        EXPECT_NEAR(distance(x), away, 1e-9);
      }
      EXPECT_LE(distance(x), away + 1e-9);
      EXPECT_LE(distance((x + y) / 2), (distance(x) + distance(y)) / 2 + 1e-12);
    }
  }
}

// Behind the triangle no sphere is centred in the ball, and one that is beside the ball is no larger than the
// way to the triangle.
TEST(Prism, WithABallOutsideBoundsTheDistanceOfWhatIsNotInIt) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto point = [&] { return Point(unit(random), unit(random), unit(random)); };
  int less = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const std::array<Point, 3> corners{4 * point(), 4 * point(), 4 * point()};
    const Point cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (cross.norm() < 0.01) continue;
    const Point inwards = cross.normalized();
    Prism prism(corners, inwards);
    const Point centre = (corners[0] + corners[1] + corners[2]) / 3 + point();
    const double half = 0.5;
    CornerValues distances;
    const double before = prism.farthestBehind(cornersOf(centre, half), distances);
    const double radius = 10 * std::abs(unit(random));
    const Ball ball{centre - (radius + unit(random)) * inwards + 0.3 * point(), radius};
    prism.back(ball);
    const double behind = prism.farthestBehind(cornersOf(centre, half), distances);
    EXPECT_LE(behind, before);
    less += behind < before;
    const auto world = [](const Point& x) { return Vec3d{x[0], x[1], x[2]}; };
    const Triangle triangle(world(corners[0]), world(corners[1]), world(corners[2]));
    for (int i = 0; i < 200; ++i) {
      const Point x = centre + half * point();
      Vec3d nearest;
      if (inwards.dot(x - corners[0]) < 0 && ball.distance(x) > 0) {
        EXPECT_LE(std::sqrt(triangle.closest(world(x), nearest)), behind + 1e-9);
      }
    }
  }
  EXPECT_GT(less, 100);
}

TEST(RadiusSchedule, StepsEncloseEveryRadius) {
  const RadiusSchedule schedule(1, 1e-3, 1.0075);
  std::mt19937_64 random(9);
  std::uniform_real_distribution<float> exponent(-3, 0);
  for (int i = 0; i < 10000; ++i) {
    const float radius = std::pow(10.0f, exponent(random));
    if (radius <= schedule[schedule.size() - 1]) continue;
    const std::size_t step = schedule.below(radius);
    EXPECT_LE(radius, schedule[step]);
    EXPECT_GT(radius, schedule[step + 1]);
  }
  for (std::size_t step = 0; step + 1 < schedule.size(); ++step)
    EXPECT_EQ(schedule.below(schedule[step]), step);
}

TEST(CellQueue, GivesBackTheLargest) {
  const RadiusSchedule schedule(1, 0.01, 1.1);
  CellQueue queue(schedule);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<float> unit(0, 1);
  std::size_t above = 0, live = 0;
  const std::size_t step = 20;
  for (int i = 0; i < 1000; ++i) {
    Cell cell;
    cell.upper = unit(random);
    queue.push(cell);
    live += cell.upper > schedule[schedule.size() - 1];
    above += cell.upper > schedule[step];
  }
  EXPECT_EQ(queue.live(), live);
  const std::vector<Cell> taken = queue.takeAbove(step);
  EXPECT_EQ(taken.size(), above);
  for (const Cell& cell : taken) EXPECT_GT(cell.upper, schedule[step]);
  EXPECT_EQ(queue.top(), step);
}

}  // namespace
}  // namespace innersphere::test

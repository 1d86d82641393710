#include "trade_overlaps.hpp"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "innersphere/query.hpp"
#include "source.hpp"
#include "timing.hpp"
#include "trade_poses.hpp"

namespace innersphere::benchmarks {
namespace {

using demo::BodyShape;

constexpr std::size_t kPoses = 8;
constexpr double kShare = 0.02;  // of the solid's volume, that each copy shares with it

double degreesBetween(const Vec3d& a, const Vec3d& b) {
  const auto dot = [](const Vec3d& u, const Vec3d& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; };
  const double lengths = std::sqrt(dot(a, a) * dot(b, b));
  if (!(lengths > 0)) return 90;  // no force at all
  return std::acos(std::clamp(dot(a, b) / lengths, -1.0, 1.0)) * 180 / M_PI;
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

/// Sums all contacts, where Bullet's own class would keep four.
class ForceOfContacts : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3& normal_on_b, const btVector3&, btScalar distance) override {
    if (distance < 0) force_ += normal_on_b * distance;
  }
  Vec3d onB() const { return {double(force_.x()), double(force_.y()), double(force_.z())}; }

 private:
  btVector3 force_{0, 0, 0};
};

/// Two bodies with one of Bullet's own shapes.
class BulletPair {
 public:
  BulletPair(const Way& way, const Solid& solid, const Packing& packing)
      : shape_(demo::BodyOptions{way.shape, way.concavity, {}}, solid, packing, way.spheres,
               btTransform::getIdentity()),
        dispatcher_(&configuration_) {
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    a_.setCollisionShape(&shape_.shape());
    b_.setCollisionShape(&shape_.shape());
  }
  ~BulletPair() {
    if (!algorithm_) return;
    algorithm_->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm_);
  }

  std::size_t parts() const { return shape_.parts(); }

  Vec3d force(const Placement& copy) {
    const Mat3d& m = copy.rotation;
    const auto real = [](double x) { return static_cast<btScalar>(x); };
    b_.setWorldTransform(btTransform(
        btMatrix3x3(real(m[0]), real(m[1]), real(m[2]), real(m[3]), real(m[4]), real(m[5]), real(m[6]),
                    real(m[7]), real(m[8])),
        btVector3(real(copy.translation[0]), real(copy.translation[1]), real(copy.translation[2]))));
    const btCollisionObjectWrapper a(nullptr, &shape_.shape(), &a_, a_.getWorldTransform(), -1, -1);
    const btCollisionObjectWrapper b(nullptr, &shape_.shape(), &b_, b_.getWorldTransform(), -1, -1);
    // As a world does: the algorithm of a pair is kept.
    if (!algorithm_) algorithm_ = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    ForceOfContacts result(&a, &b);
    algorithm_->processCollision(&a, &b, btDispatcherInfo(), &result);
    return result.onB();
  }

 private:
  demo::BulletShape shape_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btCollisionObject a_, b_;
  btCollisionAlgorithm* algorithm_ = nullptr;
};

class Subject {
 public:
  Subject(const std::string& source, std::size_t passes, PackingStore& store, TradeTable& table)
      : solid_(solidFrom(source)),
        packing_(store.of(*solid_)),
        model_(packing_),
        scene_("overlap-" + plainName(source)),
        passes_(passes),
        table_(table) {
    std::fprintf(stderr, "%s: sampling the truth ...\n", scene_.c_str());
    poses_ = touchingPoses(*solid_, kPoses, kShare);
  }

  void measure() {
    for (const Backend backend : {Backend::cpu, Backend::cuda}) {
      if (backend == Backend::cuda && !cudaAvailable()) continue;
      QueryContextOptions options;
      options.backend = backend;
      options.threads = 1;
      QueryContext context(options);
      for (const Estimator estimator : {Estimator::raw, Estimator::volume_true}) {
        measurePackings(context, backend, estimator);
      }
    }
    Way way;
    way.rate = 0;
    way.shape = BodyShape::gimpact;
    measureBullet(way);
    way.shape = BodyShape::convex;
    for (const double concavity : {0.01, 0.003, 0.001}) {
      way.concavity = concavity;
      measureBullet(way);
    }
    way.shape = BodyShape::spheres;
    for (const std::size_t spheres : {std::size_t{64}, std::size_t{256}, std::size_t{1024}}) {
      way.spheres = spheres;
      measureBullet(way);
    }
  }

 private:
  void measurePackings(QueryContext& context, Backend backend, Estimator estimator) {
    for (const VolumeTrueRadii& prefix : packing_->volume_true) {
      if (!coarse(prefix.count) && prefix.count != packing_->spheres.size()) continue;
      std::vector<Overlap> overlaps(poses_.size());
      const auto times = leastTimes(poses_.size(), passes_, [&](std::size_t i) {
        const PairQuery query{&model_,
                              &model_,
                              placed(*packing_, {}),
                              placed(*packing_, poses_[i].placement),
                              prefix.count,
                              prefix.count,
                              0};
        overlaps[i] = context.overlap(query, {Want::wrench, estimator});
      });
      Way way;
      way.rate = 0;
      way.estimator = estimator;
      way.backend = backend;
      way.spheres = prefix.count;
      Measured volume{scene_, "volume", prefix.count, 0, 0, "%", meanOf(times)};
      Measured direction{scene_, "direction", prefix.count, 0, 0, "deg", meanOf(times)};
      for (std::size_t i = 0; i < poses_.size(); ++i) {
        volume.error += 100 * std::fabs(overlaps[i].volume / poses_[i].volume - 1) / kPoses;
        // The paper's force, and the gradient of the volume.
        const Vec3d& force = estimator == Estimator::raw ? overlaps[i].force : overlaps[i].area;
        direction.error += degreesBetween(force, outwards(i)) / kPoses;
      }
      volume.value = volume.error;
      direction.value = direction.error;
      table_.add(way, volume);
      table_.add(way, direction);
      std::fprintf(stderr, "%s: %s: %.3g %%, %.3g deg, %.3g us\n", scene_.c_str(), describe(way).c_str(),
                   volume.error, direction.error, volume.time);
    }
  }

  void measureBullet(const Way& way) {
    BulletPair pair(way, *solid_, *packing_);
    std::vector<Vec3d> forces(poses_.size());
    const auto times = leastTimes(poses_.size(), passes_,
                                  [&](std::size_t i) { forces[i] = pair.force(poses_[i].placement); });
    Measured direction{scene_, "direction", pair.parts(), 0, 0, "deg", meanOf(times)};
    for (std::size_t i = 0; i < poses_.size(); ++i)
      direction.error += degreesBetween(forces[i], outwards(i)) / kPoses;
    direction.value = direction.error;
    table_.add(way, direction);
    std::fprintf(stderr, "%s: %s: %.3g deg, %.3g us\n", scene_.c_str(), describe(way).c_str(),
                 direction.error, direction.time);
  }

  /// The direction in which the overlap shrinks fastest.
  Vec3d outwards(std::size_t pose) const {
    const Vec3d& g = poses_[pose].gradient;
    return {-g[0], -g[1], -g[2]};
  }

  static bool coarse(std::size_t count) {
    return count == 64 || count == 256 || count == 1024 || count == 4096 || count == 16384;
  }

  std::unique_ptr<Solid> solid_;
  std::shared_ptr<const Packing> packing_;
  CollisionModel model_;
  std::string scene_;
  std::size_t passes_;
  TradeTable& table_;
  std::vector<ExactPose> poses_;
};

}  // namespace

void measureOverlaps(const std::vector<std::string>& sources, std::size_t passes, PackingStore& store,
                     TradeTable& table) {
  for (const std::string& source : sources) Subject(source, passes, store, table).measure();
}

}  // namespace innersphere::benchmarks

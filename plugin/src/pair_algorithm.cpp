#include "pair_algorithm.hpp"

#include <optional>
#include <utility>

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "innersphere/error.hpp"
#include "log.hpp"
#include "manifold_set.hpp"
#include "penalty.hpp"
#include "surface_contact.hpp"
#include "sweep.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

using Wrapper = btCollisionObjectWrapper;

btScalar sizeOf(const PackingShape& packing, const btCollisionShape& other) {
  const btScalar size = packing.getAngularMotionDisc();
  return other.isInfinite() ? size : btMin(size, other.getAngularMotionDisc());
}

}  // namespace

struct PairAlgorithm::State {
  State(btDispatcher* d, std::shared_ptr<Registration> owner, bool closest_query)
      : dispatcher(d), registration(std::move(owner)), closest(closest_query), manifolds(d) {}
  ~State() { forget(); }

  /// Contact of A, a packing, with B.
  const std::vector<ContactPatch>& update(const ContactOptions& options, const Wrapper& a, const Wrapper& b,
                                          btScalar separation, btScalar time_step) {
    const PackingShape& packing = *PackingShape::from(a.getCollisionShape());
    if (a.getCollisionShape() != shape_a || b.getCollisionShape() != shape_b) {
      forget();
      shape_a = a.getCollisionShape();
      shape_b = b.getCollisionShape();
    }
    if (const PackingShape* other = PackingShape::from(shape_b)) {
      const PackingSide side_a(a, packing), side_b(b, *other);
      if (!packings) {
        packings.emplace(side_a, side_b);
        if (!closest) registration->batch().add(&*packings);
      }
      packings->time_step = time_step;
      return registration->batch().update(*packings, side_a, side_b, separation);
    }
    if (!surface) surface.emplace(packing, *shape_b);
    const btScalar sweep = sweepOf(*a.getCollisionObject(), *b.getCollisionObject(), time_step);
    return surface->update(options, a.getWorldTransform(), b.getWorldTransform(), btMax(separation, sweep));
  }

  void forget() {
    if (packings && !closest) registration->batch().remove(&*packings);
    packings.reset();
    surface.reset();
  }

  /// Penalty forces of the last update, once a step. `origin`: of A's packing in the world.
  void push(const btCollisionObject& a, const btCollisionObject& b, const btVector3& origin,
            const ContactLaw& law, btScalar damping, const btDispatcherInfo& dispatch) {
    const std::uint64_t step = registration->steps().of(dispatch);
    if (step == pushed_step || !(dispatch.m_timeStep > 0)) return;
    pushed_step = step;
    if (!dispatcher->needsResponse(&a, &b)) return;
    static thread_local btManifoldArray all;
    all.resize(0);
    manifolds.append(all);
    const btVector3 arm =
        packings ? packings->b.shape->impl().toWorld(packings->b.transform).getOrigin() : origin;
    penalty = Penalty(a, b, damping, dispatch.m_timeStep)
                  .push(packings ? packings->overlap : surface->overlap(), law.penaltyStiffness(), arm, all);
  }

  /// Once for each pair: a body that is lost stays lost.
  void report(const std::string& message) {
    if (!reported) log(message);
    reported = true;
  }

  btDispatcher* const dispatcher;
  const std::shared_ptr<Registration> registration;
  const bool closest;
  bool reported = false;
  std::uint64_t pushed_step = 0;  ///< when penalty forces acted last
  PenaltyReport penalty;
  const btCollisionShape* shape_a = nullptr;
  const btCollisionShape* shape_b = nullptr;
  std::optional<PackingContact> packings;
  std::optional<SurfaceContact> surface;
  ManifoldSet manifolds;
};

PairAlgorithm::PairAlgorithm(const btCollisionAlgorithmConstructionInfo& info,
                             std::shared_ptr<Registration> registration, bool closest)
    : btCollisionAlgorithm(info),
      state_(std::make_unique<State>(m_dispatcher, std::move(registration), closest)) {}

PairAlgorithm::~PairAlgorithm() = default;

void PairAlgorithm::processCollision(const Wrapper* body0, const Wrapper* body1,
                                     const btDispatcherInfo& dispatch, btManifoldResult* result) {
  const Wrapper* a = body0;
  const Wrapper* b = body1;
  if (PackingShape::from(a->getCollisionShape()) == nullptr) std::swap(a, b);
  const PackingShape* packing = PackingShape::from(a->getCollisionShape());
  if (packing == nullptr) return;  // the user has given both bodies another shape

  const btCollisionObject& object_a = *a->getCollisionObject();
  const btCollisionObject& object_b = *b->getCollisionObject();
  const btScalar time_step = state_->closest ? btScalar(0) : dispatch.m_timeStep;
  static const std::vector<ContactPatch> kNone;
  const std::vector<ContactPatch>* patches = &kNone;
  ContactOptions options = state_->registration->options();
  bool updated = false;
  if (!isFinite(a->getWorldTransform()) || !isFinite(b->getWorldTransform())) {
    state_->report("A body's transform is not finite; its contacts are skipped. Remove it from the world.");
  } else {
    try {
      patches = &state_->update(options, *a, *b, result->m_closestPointDistanceThreshold, time_step);
      updated = true;
    } catch (const Error& error) {
      state_->report(std::string("Contacts of a pair of bodies are skipped: ") + error.what());
    }
  }
  // A law of the user's own on a body takes the place of ours.
  if (((object_a.getCollisionFlags() | object_b.getCollisionFlags()) &
       btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) != 0) {
    options.response = Response::rigid;
  }
  if (options.response == Response::penalty && !Penalty::applies(object_a, object_b))
    options.response = Response::compliant;
  const ContactLaw law(options, reducedMass(object_a, object_b), dispatch.m_timeStep,
                       sizeOf(*packing, *b->getCollisionShape()));
  const btVector3 origin = packing->impl().toWorld(a->getWorldTransform()).getOrigin();
  if (state_->closest) {
    ManifoldSet::report(object_a, object_b, origin, *patches, result);
  } else {
    state_->manifolds.write(object_a, object_b, origin, *patches, law, sweepOf(object_a, object_b, time_step),
                            result);
    if (updated && law.penalty())
      state_->push(object_a, object_b, origin, law, btScalar(options.damping), dispatch);
  }
}

btScalar PairAlgorithm::calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                              btManifoldResult*) {
  return 1;
}

void PairAlgorithm::getAllContactManifolds(btManifoldArray& manifolds) {
  state_->manifolds.append(manifolds);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere

#include "pair_cache/surface_batch.hpp"

#include <mutex>

#include "common/motion_bound.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

btScalar neededSeparation(const SurfacePair& pair, btScalar time_step) {
  return btMax(pair.separation, sweepOf(*pair.a.object, *pair.b.object, time_step));
}

}  // namespace

void SurfaceBatch::setOptions(const ContactOptions& options) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  options_ = options;
  live_.forEach([](SurfacePair& pair) {
    pair.reached.reset();
    pair.look->reset();
  });
}

void SurfaceBatch::add(SurfacePair* pair) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  pair->look = looks_.add(pair->a, pair->b);
  live_.add(pair);
}

void SurfaceBatch::remove(SurfacePair* pair) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  looks_.remove(pair->look);
  pair->look = &pair->own_look;
  live_.remove(pair);
}

bool SurfaceBatch::hasDelivered(SurfacePair& pair, const btCollisionObjectWrapper& a,
                                const btCollisionObjectWrapper& b, btScalar separation, btScalar time_step) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  LookBoard::follow(*pair.look, pair.a, pair.b);
  if (pair.separation != separation || pair.a.nesting < 0 || pair.b.nesting < 0) return false;
  const auto isHere = [&] { return pair.a.isWhere(a) && pair.b.isWhere(b); };
  if (!isHere()) {
    if (!looks_.isDue(*pair.look)) return false;
    lookAtAll(time_step);
    if (!isHere()) return false;
  }
  if (!pair.look->received || !looks_.isFresh(*pair.look) || !pair.a.isUpToDate() ||
      pair.reached != neededSeparation(pair, time_step))
    return false;
  looks_.ask(*pair.look);
  return true;
}

void SurfaceBatch::launch(btScalar time_step) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  lookAtAll(time_step);
}

const std::vector<ContactPatch>& SurfaceBatch::update(SurfacePair& pair, const PackingSide& a,
                                                      const BodySide& b, btScalar separation,
                                                      btScalar time_step) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  LookBoard::follow(*pair.look, pair.a, pair.b);
  if (pair.separation != separation) pair.reached.reset();
  pair.separation = separation;
  const auto isHere = [&] { return pair.a.isWhere(a) && pair.b.isWhere(b); };
  if (!isHere() && looks_.isDue(*pair.look)) lookAtAll(time_step);
  const bool up_to_date = looks_.isFresh(*pair.look) && pair.a.isAlike(a) && isHere() &&
                          pair.reached == neededSeparation(pair, time_step);
  if (!up_to_date) place(pair, a, b, time_step);
  looks_.ask(*pair.look);
  return pair.contact.patches();
}

Overlap SurfaceBatch::volumesOf(SurfacePair& pair) {
  const std::lock_guard<std::mutex> lock(looks_.mutex());
  LookBoard::follow(*pair.look, pair.a, pair.b);
  return pair.contact.volumesOf(options_, pair.a.transform, pair.b.transform);
}

void SurfaceBatch::lookAtAll(btScalar time_step) {
  looks_.begin(time_step);
  const auto look = [&](SurfacePair& pair) {
    if (!looks_.join(*pair.look)) return;
    if (looks_.staysCalm(*pair.look)) {
      if (pair.contact.isAsBefore()) return;
      pair.look->reset();
    }
    lookAt(pair, time_step);
  };
  live_.forEachInParallel(look, fetchLook<SurfacePair>, fetchUnlessCalm<SurfacePair>);
}

void SurfaceBatch::lookAt(SurfacePair& pair, btScalar time_step) const {
  if (!isActive(pair.a, pair.b)) return;
  PackingSide a = pair.a;
  BodySide b = pair.b;
  if (!a.refresh() || !b.refresh()) return;
  pair.look->wanted = false;
  place(pair, a, b, time_step);
  pair.look->received =
      pair.separation == 0 && pair.receiver.receive(pair.contact.patches(), options_, time_step);
  if (pair.look->received) looks_.calm(*pair.look, pair.contact.leeway(), pair.contact.reach());
}

void SurfaceBatch::place(SurfacePair& pair, const PackingSide& a, const BodySide& b,
                         btScalar time_step) const {
  pair.look->reset();
  pair.a = a;
  pair.b = b;
  const btScalar needed = neededSeparation(pair, time_step);
  pair.contact.update(options_, a.transform, b.transform, needed);
  pair.reached = needed;
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere

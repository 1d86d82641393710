#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include "peer.hpp"

namespace innersphere::benchmarks {
namespace {

/// Keeps every contact, where Bullet's own would keep four.
class AllContacts : public btManifoldResult {
 public:
  using btManifoldResult::btManifoldResult;
  void addContactPoint(const btVector3& normal, const btVector3& point, btScalar depth) override {
    contacts_.push_back({normal, point, depth});
  }
  std::size_t count() const { return contacts_.size(); }

 private:
  struct Contact {
    btVector3 normal, point;
    btScalar depth;
  };
  std::vector<Contact> contacts_;
};

class GImpactPeer : public Peer {
 public:
  explicit GImpactPeer(const Mesh& mesh) : dispatcher_(&configuration_), algorithm_(nullptr, {dispatcher_}) {
    for (const auto& t : mesh.triangles)
      triangles_.addTriangle(point(mesh.vertices[t[0]]), point(mesh.vertices[t[1]]),
                             point(mesh.vertices[t[2]]));
    for (auto* body : {&a_, &b_}) {
      body->shape = std::make_unique<btGImpactMeshShape>(&triangles_);
      body->shape->setMargin(0);
      body->shape->updateBound();
      body->object.setCollisionShape(body->shape.get());
    }
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
  }

  std::string name() const override { return "GImpact"; }

  std::size_t contacts(const Placement& copy) override {
    const Mat3d& m = copy.rotation;
    const auto real = [](double x) { return static_cast<btScalar>(x); };
    b_.object.setWorldTransform(
        btTransform(btMatrix3x3(real(m[0]), real(m[1]), real(m[2]), real(m[3]), real(m[4]), real(m[5]),
                                real(m[6]), real(m[7]), real(m[8])),
                    point(copy.translation)));
    const btCollisionObjectWrapper a(nullptr, a_.shape.get(), &a_.object, a_.object.getWorldTransform(), -1,
                                     -1);
    const btCollisionObjectWrapper b(nullptr, b_.shape.get(), &b_.object, b_.object.getWorldTransform(), -1,
                                     -1);
    // As a world does: the algorithm of a pair is kept.
    if (!algorithm_)
      algorithm_.reset(dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS));
    AllContacts found(&a, &b);
    algorithm_->processCollision(&a, &b, btDispatcherInfo(), &found);
    return found.count();
  }

 private:
  struct Body {
    std::unique_ptr<btGImpactMeshShape> shape;
    btCollisionObject object;
  };

  static btVector3 point(const Vec3d& p) {
    return {static_cast<btScalar>(p[0]), static_cast<btScalar>(p[1]), static_cast<btScalar>(p[2])};
  }

  struct Release {
    btDispatcher& dispatcher;
    void operator()(btCollisionAlgorithm* algorithm) const {
      algorithm->~btCollisionAlgorithm();
      dispatcher.freeCollisionAlgorithm(algorithm);
    }
  };

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btTriangleMesh triangles_;
  Body a_, b_;
  std::unique_ptr<btCollisionAlgorithm, Release> algorithm_;
};

}  // namespace

std::unique_ptr<Peer> makeGImpactPeer(const Mesh& mesh) {
  return std::make_unique<GImpactPeer>(mesh);
}

}  // namespace innersphere::benchmarks

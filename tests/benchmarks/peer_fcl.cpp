#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>

#include <limits>

#include "peer.hpp"

namespace innersphere::benchmarks {
namespace {

class FclPeer : public Peer {
 public:
  explicit FclPeer(const Mesh& mesh) : model_(std::make_shared<Model>()) {
    std::vector<fcl::Vector3d> vertices;
    std::vector<fcl::Triangle> triangles;
    for (const Vec3d& v : mesh.vertices) vertices.emplace_back(v[0], v[1], v[2]);
    for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model_->beginModel();
    model_->addSubModel(vertices, triangles);
    model_->endModel();
  }

  std::string name() const override { return "FCL"; }

  std::size_t contacts(const Placement& copy) override {
    fcl::Transform3d there = fcl::Transform3d::Identity();
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) there.linear()(i, j) = copy.rotation[static_cast<std::size_t>(3 * i + j)];
      there.translation()[i] = copy.translation[static_cast<std::size_t>(i)];
    }
    const fcl::CollisionRequestd request(std::numeric_limits<std::size_t>::max(), true);
    fcl::CollisionResultd result;
    fcl::collide(model_.get(), fcl::Transform3d::Identity(), model_.get(), there, request, result);
    return result.numContacts();
  }

 private:
  using Model = fcl::BVHModel<fcl::OBBRSSd>;  // its fastest here
  std::shared_ptr<Model> model_;
};

}  // namespace

std::unique_ptr<Peer> makeFclPeer(const Mesh& mesh) {
  return std::make_unique<FclPeer>(mesh);
}

}  // namespace innersphere::benchmarks

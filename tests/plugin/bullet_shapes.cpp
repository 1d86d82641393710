#include "bullet_shapes.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>

#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btMinkowskiSumShape.h>
#include <BulletCollision/CollisionShapes/btMultimaterialTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexMaterialArray.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include "test_packings.hpp"

namespace innersphere::test {
namespace {

/// A shape under another type's number.
template <typename Base>
struct Typed : Base {
  template <typename... Args>
  explicit Typed(int type, Args&&... args) : Base(std::forward<Args>(args)...) {
    this->m_shapeType = type;
  }
};

const btVector3 kHalf(2, 2, 1);  // of all boxes

BulletShape below(std::shared_ptr<btCollisionShape> shape, btScalar top,
                  const btQuaternion& turn = btQuaternion::getIdentity(),
                  std::shared_ptr<void> data = nullptr) {
  return {std::move(shape), btTransform(turn, btVector3(0, 0, -top)), std::move(data)};
}

BulletShape typedBox(int type) {
  return below(std::make_shared<Typed<btBoxShape>>(type, kHalf), 1);
}

const std::vector<btVector3>& corners() {
  static const std::vector<btVector3> all = [] {
    std::vector<btVector3> points;
    for (int i = 0; i < 8; ++i) {
      points.push_back(kHalf * btVector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    }
    return points;
  }();
  return all;
}

std::shared_ptr<btConvexHullShape> hull() {
  auto shape = std::make_shared<btConvexHullShape>();
  for (const btVector3& corner : corners()) shape->addPoint(corner);
  return shape;
}

const int kBoxIndices[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                             2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

std::shared_ptr<btTriangleMesh> boxMesh() {
  auto mesh = std::make_shared<btTriangleMesh>();
  for (int t = 0; t < 12; ++t) {
    mesh->addTriangle(corners()[kBoxIndices[3 * t]], corners()[kBoxIndices[3 * t + 1]],
                      corners()[kBoxIndices[3 * t + 2]]);
  }
  return mesh;
}

/// In Bullet the margin is part of a hull or a cone.
template <typename Shape>
BulletShape withMargin(std::shared_ptr<Shape> shape, btScalar top,
                       const btQuaternion& turn = btQuaternion::getIdentity(),
                       std::shared_ptr<void> data = nullptr) {
  const btScalar margin = shape->getMargin();
  return below(shape, top + margin, turn, std::move(data));
}

BulletShape multiSphere() {
  std::vector<btVector3> centres;
  for (int i = 0; i < 4; ++i) centres.emplace_back(btScalar(i & 1 ? 2 : -2), btScalar(i & 2 ? 2 : -2), 0);
  const std::vector<btScalar> radii(4, btScalar(0.5));
  return below(std::make_shared<btMultiSphereShape>(centres.data(), radii.data(), 4), btScalar(0.5));
}

BulletShape pointCloud() {
  auto points = std::make_shared<std::vector<btVector3>>(corners());
  return withMargin(std::make_shared<btConvexPointCloudShape>(points->data(), 8, btVector3(1, 1, 1)), 1,
                    btQuaternion::getIdentity(), points);
}

BulletShape minkowski(int type) {
  auto box = std::make_shared<btBoxShape>(kHalf);
  auto ball = std::make_shared<btSphereShape>(btScalar(0.25));
  auto data = std::make_shared<std::pair<decltype(box), decltype(ball)>>(box, ball);
  auto sum = std::make_shared<Typed<btMinkowskiSumShape>>(type, box.get(), ball.get());
  return below(sum, btScalar(1.25), btQuaternion::getIdentity(), data);
}

BulletShape triangleMesh() {
  auto mesh = boxMesh();
  return below(std::make_shared<btBvhTriangleMeshShape>(mesh.get(), true), 1, btQuaternion::getIdentity(),
               mesh);
}

BulletShape scaledMesh() {
  auto mesh = boxMesh();
  auto tree = std::make_shared<btBvhTriangleMeshShape>(mesh.get(), true);
  auto data = std::make_shared<std::pair<decltype(mesh), decltype(tree)>>(mesh, tree);
  return below(std::make_shared<btScaledBvhTriangleMeshShape>(tree.get(), btVector3(1, 1, 2)), 2,
               btQuaternion::getIdentity(), data);
}

BulletShape materialMesh() {
  struct Data {
    std::vector<int> indices{std::begin(kBoxIndices), std::end(kBoxIndices)};
    std::vector<btVector3> vertices = corners();
    btMaterial material{btScalar(0.5), 0};
    std::vector<int> material_of = std::vector<int>(12, 0);
    btTriangleIndexVertexMaterialArray mesh{12,
                                            indices.data(),
                                            3 * sizeof(int),
                                            8,
                                            &vertices[0][0],
                                            sizeof(btVector3),
                                            1,
                                            reinterpret_cast<unsigned char*>(&material),
                                            sizeof(btMaterial),
                                            material_of.data(),
                                            sizeof(int)};
  };
  auto data = std::make_shared<Data>();
  return below(std::make_shared<btMultimaterialTriangleMeshShape>(&data->mesh, true), 1,
               btQuaternion::getIdentity(), data);
}

BulletShape gimpact() {
  auto mesh = boxMesh();
  auto shape = std::make_shared<btGImpactMeshShape>(mesh.get());
  shape->setMargin(0);
  shape->updateBound();
  return below(shape, 1, btQuaternion::getIdentity(), mesh);
}

BulletShape terrain() {
  auto heights = std::make_shared<std::vector<float>>(16 * 16, 0.0f);
  auto field = std::make_shared<btHeightfieldTerrainShape>(16, 16, heights->data(), btScalar(-1), btScalar(1),
                                                           2, false);
  return {field, btTransform::getIdentity(), heights};
}

/// A user's own mesh under a type's number.
struct OwnMesh : btConcaveShape {
  explicit OwnMesh(int type) { m_shapeType = type; }
  void getAabb(const btTransform& t, btVector3& min, btVector3& max) const override {
    const btVector3 half(4, 4, btScalar(0.1));
    min = t.getOrigin() - half;
    max = t.getOrigin() + half;
  }
  void processAllTriangles(btTriangleCallback* callback, const btVector3&, const btVector3&) const override {
    btVector3 one[3] = {btVector3(-4, -4, 0), btVector3(4, -4, 0), btVector3(4, 4, 0)};
    btVector3 two[3] = {btVector3(-4, -4, 0), btVector3(4, 4, 0), btVector3(-4, 4, 0)};
    callback->processTriangle(one, 0, 0);
    callback->processTriangle(two, 0, 1);
  }
  void setLocalScaling(const btVector3&) override {}
  const btVector3& getLocalScaling() const override { return scaling_; }
  void calculateLocalInertia(btScalar, btVector3& inertia) const override { inertia.setZero(); }
  const char* getName() const override { return "OwnMesh"; }

 private:
  const btVector3 scaling_{1, 1, 1};
};

BulletShape compoundOf(BulletShape child) {
  auto compound = std::make_shared<btCompoundShape>();
  compound->addChildShape(child.place, child.shape.get());
  return {compound, btTransform::getIdentity(), std::make_shared<BulletShape>(std::move(child))};
}

/// Writes what btSdfCollisionShape reads.
class Bytes {
 public:
  template <typename Value>
  void add(const Value& value) {
    data_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  const std::string& data() const { return data_; }

 private:
  std::string data_;
};

/// Of a cell from -1 to 1: its corners, then two nodes on each of the edges along x, y and z.
std::vector<btVector3> nodesOfCell() {
  std::vector<btVector3> nodes;
  for (int i = 0; i < 8; ++i) nodes.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  for (int axis = 0; axis < 3; ++axis) {
    const int slow = axis == 1 ? 2 : axis == 0 ? 1 : 0, fast = 3 - axis - slow;
    for (int i = 0; i < 8; ++i) {
      btVector3 node(0, 0, 0);
      node[axis] = btScalar(i & 1 ? 1 : -1) / 3;
      node[fast] = btScalar(i & 2 ? 1 : -1);
      node[slow] = btScalar(i & 4 ? 1 : -1);
      nodes.push_back(node);
    }
  }
  return nodes;
}

using Make = std::function<BulletShape()>;

const std::map<std::string, Make>& makers() {
  static const std::map<std::string, Make> all = {
      {"box", [] { return below(std::make_shared<btBoxShape>(kHalf), 1); }},
      {"triangle",
       [] {
         return withMargin(
             std::make_shared<btTriangleShape>(btVector3(-6, -4, 0), btVector3(6, -4, 0), btVector3(0, 8, 0)),
             0);
       }},
      {"tetrahedron",
       [] {
         return withMargin(std::make_shared<btBU_Simplex1to4>(btVector3(-6, -4, 0), btVector3(6, -4, 0),
                                                              btVector3(0, 8, 0), btVector3(0, 0, -4)),
                           0);
       }},
      {"convex_triangle_mesh",
       [] {
         auto mesh = boxMesh();
         return withMargin(std::make_shared<btConvexTriangleMeshShape>(mesh.get()), 1,
                           btQuaternion::getIdentity(), mesh);
       }},
      {"convex_hull", [] { return withMargin(hull(), 1); }},
      {"convex_point_cloud", pointCloud},
      {"own_polyhedron", [] { return typedBox(CUSTOM_POLYHEDRAL_SHAPE_TYPE); }},
      {"implicit_convex", [] { return typedBox(IMPLICIT_CONVEX_SHAPES_START_HERE); }},
      {"sphere", [] { return below(std::make_shared<btSphereShape>(2), 2); }},
      {"multi_sphere", multiSphere},
      {"capsule", [] { return below(std::make_shared<btCapsuleShape>(2, 4), 2); }},
      {"capsule_x", [] { return below(std::make_shared<btCapsuleShapeX>(2, 4), 2); }},
      {"capsule_z", [] { return below(std::make_shared<btCapsuleShapeZ>(2, 2), 3); }},
      {"cone",
       [] {
         return withMargin(std::make_shared<btConeShape>(3, 2), 1,
                           btQuaternion(btVector3(1, 0, 0), -SIMD_HALF_PI));
       }},
      {"cone_x",
       [] {
         return withMargin(std::make_shared<btConeShapeX>(3, 2), 1,
                           btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI));
       }},
      {"cone_z",
       [] {
         return withMargin(std::make_shared<btConeShapeZ>(3, 2), 1,
                           btQuaternion(btVector3(1, 0, 0), SIMD_PI));
       }},
      {"convex", [] { return typedBox(CONVEX_SHAPE_PROXYTYPE); }},
      {"cylinder", [] { return below(std::make_shared<btCylinderShape>(btVector3(2, 2, 2)), 2); }},
      {"cylinder_x", [] { return below(std::make_shared<btCylinderShapeX>(btVector3(2, 2, 2)), 2); }},
      {"cylinder_z", [] { return below(std::make_shared<btCylinderShapeZ>(btVector3(2, 2, 2)), 2); }},
      {"uniform_scaling",
       [] {
         auto box = std::make_shared<btBoxShape>(kHalf);
         return below(std::make_shared<btUniformScalingShape>(box.get(), 2), 2, btQuaternion::getIdentity(),
                      box);
       }},
      {"minkowski_sum", [] { return minkowski(MINKOWSKI_SUM_SHAPE_PROXYTYPE); }},
      {"minkowski_difference", [] { return minkowski(MINKOWSKI_DIFFERENCE_SHAPE_PROXYTYPE); }},
      {"box_2d", [] { return below(std::make_shared<btBox2dShape>(kHalf), 1); }},
      {"convex_2d",
       [] {
         auto inner = hull();
         return below(std::make_shared<btConvex2dShape>(inner.get()), 1 + inner->getMargin(),
                      btQuaternion::getIdentity(), inner);
       }},
      {"own_convex", [] { return typedBox(CUSTOM_CONVEX_SHAPE_TYPE); }},
      {"concave_start",
       [] { return BulletShape{std::make_shared<OwnMesh>(int(CONCAVE_SHAPES_START_HERE) + 1)}; }},
      {"triangle_mesh", triangleMesh},
      {"scaled_triangle_mesh", scaledMesh},
      {"fast_concave",
       [] { return BulletShape{std::make_shared<OwnMesh>(int(FAST_CONCAVE_MESH_PROXYTYPE))}; }},
      {"terrain", terrain},
      {"gimpact", gimpact},
      {"multimaterial_mesh", materialMesh},
      {"plane",
       [] { return below(std::make_shared<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), 0); }},
      {"own_concave", [] { return BulletShape{std::make_shared<OwnMesh>(int(CUSTOM_CONCAVE_SHAPE_TYPE))}; }},
      {"compound", [] { return compoundOf(below(std::make_shared<btBoxShape>(kHalf), 1)); }},
      {"compound_of_a_mesh", [] { return compoundOf(triangleMesh()); }},
      {"nested_compound",
       [] { return compoundOf(compoundOf(below(std::make_shared<btBoxShape>(kHalf), 1))); }},
      {"packing",
       [] {
         return below(makeShape(latticeBox({3, 3, 2}, 12)), 1);
       }},
      {"nested_compound_of_a_packing",
       [] {
         return compoundOf(compoundOf(below(makeShape(latticeBox({3, 3, 2}, 12)), 1)));
       }},
      {"sdf",  // turned: its x axis is up
       [] {
         return BulletShape{makeSdf(2, 2, [](const btVector3& p) { return double(p.x()); }),
                            btTransform(btQuaternion(btVector3(0, 1, 0), -SIMD_HALF_PI))};
       }},
      {"empty", [] { return BulletShape{std::make_shared<btEmptyShape>()}; }},
      {"fluid", [] { return typedBox(HFFLUID_SHAPE_PROXYTYPE); }},
      {"buoyant", [] { return typedBox(HFFLUID_BUOYANT_CONVEX_SHAPE_PROXYTYPE); }},
      {"invalid", [] { return typedBox(INVALID_SHAPE_PROXYTYPE); }},
  };
  return all;
}

bool hasNoSurface(const std::string& name) {
  return name == "empty" || name == "fluid" || name == "buoyant" || name == "invalid";
}

std::vector<std::string> names(bool empty) {
  std::vector<std::string> result;
  for (const auto& [name, make] : makers()) {
    if (hasNoSurface(name) == empty) result.push_back(name);
  }
  return result;
}

}  // namespace

const std::vector<std::string>& bulletShapes() {
  static const std::vector<std::string> all = names(false);
  return all;
}

const std::vector<std::string>& emptyShapes() {
  static const std::vector<std::string> all = names(true);
  return all;
}

BulletShape makeBulletShape(const std::string& name) {
  return makers().at(name)();
}

std::shared_ptr<btSdfCollisionShape> makeSdf(double half, int cells,
                                             const std::function<double(const btVector3&)>& distance) {
  const std::uint64_t fields = 1, count = std::uint64_t(cells) * cells * cells;
  const std::vector<btVector3> nodes = nodesOfCell();
  const double size = 2 * half / cells;
  Bytes bytes;
  bytes.add(std::array<double, 6>{-half, -half, -half, half, half, half});
  bytes.add(std::array<std::uint32_t, 3>{std::uint32_t(cells), std::uint32_t(cells), std::uint32_t(cells)});
  bytes.add(std::array<double, 3>{size, size, size});
  bytes.add(std::array<double, 3>{1 / size, 1 / size, 1 / size});
  bytes.add(count);
  bytes.add(fields);
  // Each cell has nodes of its own.
  bytes.add(fields);
  bytes.add(count * nodes.size());
  for (int z = 0; z < cells; ++z) {
    for (int y = 0; y < cells; ++y) {
      for (int x = 0; x < cells; ++x) {
        const btVector3 middle =
            (btVector3(btScalar(x), btScalar(y), btScalar(z)) * 2 + btVector3(1, 1, 1)) * btScalar(size / 2) -
            btVector3(1, 1, 1) * btScalar(half);
        for (const btVector3& node : nodes) bytes.add(distance(middle + node * btScalar(size / 2)));
      }
    }
  }
  bytes.add(fields);
  bytes.add(count);
  for (std::uint32_t i = 0; i < count * nodes.size(); ++i) bytes.add(i);
  bytes.add(fields);
  bytes.add(count);
  for (std::uint32_t i = 0; i < count; ++i) bytes.add(i);
  auto shape = std::make_shared<btSdfCollisionShape>();
  if (!shape->initializeSDF(bytes.data().data(), int(bytes.data().size())))
    throw std::runtime_error("Bullet does not read it.");
  return shape;
}

}  // namespace innersphere::test

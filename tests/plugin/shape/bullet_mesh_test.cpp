// Reading Bullet's triangle meshes, against Bullet's own reading of them.
#include <gtest/gtest.h>

#include <cstring>

#include <btBulletCollisionCommon.h>

#include "innersphere/bullet_mesh.hpp"
#include "innersphere/error.hpp"

namespace innersphere::test {
namespace {

/// Corners of all triangles, one after the other.
struct Corners : btInternalTriangleIndexCallback {
  void internalProcessTriangleIndex(btVector3* triangle, int, int) override {
    all.insert(all.end(), triangle, triangle + 3);
  }
  std::vector<btVector3> all;
};

std::vector<btVector3> asBulletReads(const btStridingMeshInterface& triangles) {
  const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  Corners corners;
  triangles.InternalProcessAllTriangles(&corners, -far, far);
  return corners.all;
}

void expectAsBulletReads(const btStridingMeshInterface& triangles, std::size_t count) {
  const Mesh mesh = meshFrom(triangles);
  const std::vector<btVector3> corners = asBulletReads(triangles);
  ASSERT_EQ(mesh.triangles.size(), count);
  ASSERT_EQ(corners.size(), 3 * count);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d& vertex = mesh.vertices.at(mesh.triangles[i / 3][i % 3]);
    for (int k = 0; k < 3; ++k) {
      // Bullet multiplies in its own precision.
      EXPECT_NEAR(vertex[k], corners[i][k], 4e-7 * std::fabs(vertex[k])) << i;
    }
  }
}

/// Arrays of two triangles with gaps between the entries, none of them where its type would lie by itself.
template <typename Scalar, typename Index>
struct Strided {
  Strided(PHY_ScalarType scalar, PHY_ScalarType index) {
    for (int v = 0; v < 4; ++v) {
      for (int k = 0; k < 3; ++k) put(vertices, v * kVertexStride, k, Scalar(0.1 + v * 1.7 - k * k * 0.3));
    }
    const int corners[6] = {0, 1, 2, 2, 1, 3};
    for (int i = 0; i < 6; ++i) put(indices, i / 3 * kIndexStride, i % 3, Index(corners[i]));
    part.m_vertexBase = vertices;
    part.m_vertexStride = kVertexStride;
    part.m_numVertices = 4;
    part.m_vertexType = scalar;
    part.m_triangleIndexBase = indices;
    part.m_triangleIndexStride = kIndexStride;
    part.m_numTriangles = 2;
    part.m_indexType = index;
  }
  template <typename T>
  static void put(unsigned char* base, int offset, int k, T value) {
    std::memcpy(base + offset + k * int(sizeof(T)), &value, sizeof(T));
  }
  static constexpr int kVertexStride = 3 * sizeof(Scalar) + 8, kIndexStride = 3 * sizeof(Index) + 4;
  alignas(16) unsigned char vertices[4 * kVertexStride] = {};
  alignas(16) unsigned char indices[2 * kIndexStride] = {};
  btIndexedMesh part;
};

TEST(BulletMesh, ReadsEveryTypeOfAllSubParts) {
  Strided<float, std::uint32_t> a(PHY_FLOAT, PHY_INTEGER);
  Strided<double, std::uint16_t> b(PHY_DOUBLE, PHY_SHORT);
  Strided<float, std::uint8_t> c(PHY_FLOAT, PHY_UCHAR);
  Strided<double, std::uint32_t> d(PHY_DOUBLE, PHY_INTEGER);
  btTriangleIndexVertexArray triangles;
  for (const btIndexedMesh* part : {&a.part, &b.part, &c.part, &d.part})
    triangles.addIndexedMesh(*part, part->m_indexType);
  // addIndexedMesh() does not keep the vertices' type in every version.
  expectAsBulletReads(triangles, 8);
}

TEST(BulletMesh, ScalesEachAxis) {
  Strided<float, std::uint16_t> arrays(PHY_FLOAT, PHY_SHORT);
  btTriangleIndexVertexArray triangles;
  triangles.addIndexedMesh(arrays.part, PHY_SHORT);
  triangles.setScaling(btVector3(2, btScalar(-0.5), 3));
  expectAsBulletReads(triangles, 2);
  EXPECT_NEAR(meshFrom(triangles).vertices[1][0], 2 * (0.1 + 1.7), 1e-6);
}

TEST(BulletMesh, ReadsBulletsTriangleMeshes) {
  for (const bool wide : {false, true}) {
    for (const bool padded : {false, true}) {
      btTriangleMesh triangles(wide, padded);
      for (int i = 0; i < 300; ++i) {
        const btScalar x = btScalar(i);
        triangles.addTriangle(btVector3(x, 0, 1), btVector3(x + 1, 2, 3), btVector3(x, 5, 4));
      }
      expectAsBulletReads(triangles, 300);
    }
  }
}

TEST(BulletMesh, BadArraysAreErrors) {
  const auto messageOf = [](const btIndexedMesh& part) -> std::string {
    btTriangleIndexVertexArray triangles;
    triangles.addIndexedMesh(part, part.m_indexType);
    try {
      meshFrom(triangles);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      return error.what();
    }
    return "";
  };
  Strided<float, std::uint16_t> arrays(PHY_FLOAT, PHY_SHORT);
  EXPECT_EQ(messageOf(arrays.part), "");
  btIndexedMesh bad = arrays.part;
  bad.m_indexType = PHY_FIXEDPOINT88;
  EXPECT_NE(messageOf(bad).find("PHY_UCHAR"), std::string::npos);
  bad = arrays.part;
  bad.m_vertexType = PHY_SHORT;
  EXPECT_NE(messageOf(bad).find("PHY_DOUBLE"), std::string::npos);
  bad = arrays.part;
  bad.m_numVertices = 3;
  EXPECT_NE(messageOf(bad).find("vertex 3"), std::string::npos);
  bad = arrays.part;
  bad.m_vertexBase = nullptr;
  EXPECT_NE(messageOf(bad).find("no arrays"), std::string::npos);
}

TEST(BulletMesh, NoTrianglesAreAnEmptyMesh) {
  const btTriangleIndexVertexArray triangles;
  EXPECT_TRUE(meshFrom(triangles).triangles.empty());
}

}  // namespace
}  // namespace innersphere::test

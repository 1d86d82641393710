#include "mesh/import/read_assimp.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <utility>

#include "common/bounds.hpp"
#include "file/file_io.hpp"
#include "innersphere/error.hpp"
#include "mesh/mesh_report.hpp"

namespace innersphere {
namespace {

/// A node's frame in that of the file: x -> columns * x + shift.
struct Frame {
  std::array<Vec3d, 3> columns;
  Vec3d shift;

  Vec3d direction(const Vec3d& x) const { return x[0] * columns[0] + x[1] * columns[1] + x[2] * columns[2]; }
  Vec3d operator()(const Vec3d& x) const { return direction(x) + shift; }
  bool mirrors() const { return dot(columns[0], cross(columns[1], columns[2])) < 0; }
};

// Multiplied in double; assimp's own pre-transformation works in float and merges what it should not.
Frame childFrame(const Frame& parent, const aiMatrix4x4& m) {
  const auto column = [](double x, double y, double z) { return Vec3d{x, y, z}; };
  return {{parent.direction(column(m.a1, m.b1, m.c1)), parent.direction(column(m.a2, m.b2, m.c2)),
           parent.direction(column(m.a3, m.b3, m.c3))},
          parent(column(m.a4, m.b4, m.c4))};
}

class Collector {
 public:
  Collector(const aiScene& scene, const std::string& path) : scene_(scene), path_(path) {}

  void addNode(const aiNode& node, const Frame& parent) {
    const Frame frame = childFrame(parent, node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) addMesh(*scene_.mMeshes[node.mMeshes[i]], frame);
    for (unsigned i = 0; i < node.mNumChildren; ++i) addNode(*node.mChildren[i], frame);
  }

  Mesh mesh;

 private:
  void addMesh(const aiMesh& part, const Frame& frame) {
    if (!(part.mPrimitiveTypes & aiPrimitiveType_TRIANGLE)) return;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const std::string where =
        path_ + (part.mName.length > 0 ? std::string(", part ") + part.mName.C_Str() : "");
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      const Vec3d position{v.x, v.y, v.z};
      mesh.vertices.push_back(frame(position));
      if (isFinite(mesh.vertices.back())) continue;
      throw Error(ErrorCode::not_finite, "vertex " + std::to_string(i) + " of " + where + " is " +
                                             text(position) + "; remove it or export the mesh again");
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;
      std::array<std::uint32_t, 3> triangle;
      for (int k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= part.mNumVertices) {
          throw Error(ErrorCode::bad_format,
                      "face " + std::to_string(i) + " of " + where +
                          " uses a vertex that the file does not have; export the mesh again");
        }
        triangle[k] = first + face.mIndices[k];
      }
      if (frame.mirrors()) std::swap(triangle[1], triangle[2]);
      mesh.triangles.push_back(triangle);
    }
  }

  const aiScene& scene_;
  const std::string& path_;
};

}  // namespace

Mesh readAssimp(const std::string& path) {
  Assimp::Importer importer;
  // Coordinates are taken as they are written, as by whatever else reads the file: assimp would turn Z up
  // into Y up.
  importer.SetPropertyInteger(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_SortByPType);
  if (!scene || !scene->mRootNode) {
    const bool known = importer.IsExtensionSupported("." + endingOf(path));
    throw Error(ErrorCode::bad_format,
                path + " cannot be read as a mesh (" + importer.GetErrorString() + "); " +
                    (known ? "it is damaged, or not what its ending says: export it again"
                           : "use OBJ, STL, PLY, OFF or glTF with the matching ending"));
  }
  Collector collector(*scene, path);
  collector.addNode(*scene->mRootNode, {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {}});
  return std::move(collector.mesh);
}

}  // namespace innersphere

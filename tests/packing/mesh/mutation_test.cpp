// Damaged mesh files: thousands of mutations of good ones. Each ends in triangles or in an Error, and soon.
#include <gtest/gtest.h>
#include <zlib.h>

#include <chrono>
#include <sstream>

#include "file_scratch.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "mesh_shapes.hpp"
#include "mutations.hpp"

namespace innersphere::test {
namespace {

using Clock = std::chrono::steady_clock;

// A file of each kind, as other programs write them.
std::string objText(const Mesh& mesh) {
  std::ostringstream out;
  out << "# by hand\nmtllib a.mtl\no thing\n";
  for (const Vec3d& v : mesh.vertices) out << "v " << v[0] << ' ' << v[1] << ' ' << v[2] << "\nvn 0 0 1\n";
  for (const auto& t : mesh.triangles) {
    out << "f";
    for (auto v : t) out << ' ' << v + 1 << "//" << v + 1;
    out << "\n";
  }
  return out.str() + "f -1 -2 \\\n-3 -4\n";
}

std::string offText(const Mesh& mesh) {
  std::ostringstream out;
  out << "OFF\n" << mesh.vertices.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const Vec3d& v : mesh.vertices) out << v[0] << ' ' << v[1] << ' ' << v[2] << "\n";
  for (const auto& t : mesh.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << " 255 0 0\n";
  return out.str();
}

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string plyFile(const Mesh& mesh, bool binary) {
  std::ostringstream head;
  head << "ply\nformat " << (binary ? "binary_little_endian" : "ascii") << " 1.0\nelement vertex "
       << mesh.vertices.size() << "\nproperty float x\nproperty float y\nproperty double z\nelement face "
       << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  std::string file = head.str();
  std::ostringstream text;
  for (const Vec3d& v : mesh.vertices) {
    text << v[0] << ' ' << v[1] << ' ' << v[2] << "\n";
    if (!binary) continue;
    put(file, static_cast<float>(v[0]));
    put(file, static_cast<float>(v[1]));
    put(file, v[2]);
  }
  for (const auto& t : mesh.triangles) {
    text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << "\n";
    if (!binary) continue;
    put(file, std::uint8_t{3});
    for (auto v : t) put(file, static_cast<std::int32_t>(v));
  }
  return binary ? file : file + text.str();
}

std::string stlText(const Mesh& mesh) {
  std::ostringstream out;
  out << "solid thing\n";
  for (const auto& t : mesh.triangles) {
    out << " facet normal 0 0 0\n  outer loop\n";
    for (auto v : t)
      out << "   vertex " << mesh.vertices[v][0] << ' ' << mesh.vertices[v][1] << ' ' << mesh.vertices[v][2]
          << "\n";
    out << "  endloop\n endfacet\n";
  }
  return out.str() + "endsolid thing\n";
}

std::string stlBinary(const Mesh& mesh) {
  std::string file(80, ' ');
  put(file, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(file, 0.0f);
    for (auto v : t) {
      for (double x : mesh.vertices[v]) put(file, static_cast<float>(x));
    }
    put(file, std::uint16_t{0});
  }
  return file;
}

std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, bytes.size()), 0);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

// A triangle with its numbers in the file itself.
std::string gltfText() {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],
"buffers":[{"uri":"data:application/octet-stream;base64,AAABAAIAAAAAAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAA=",
"byteLength":44}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":6,"target":34963},
{"buffer":0,"byteOffset":8,"byteLength":36,"target":34962}],
"accessors":[{"bufferView":0,"byteOffset":0,"componentType":5123,"count":3,"type":"SCALAR","max":[2],"min":[0]},
{"bufferView":1,"byteOffset":0,"componentType":5126,"count":3,"type":"VEC3","max":[1,1,0],"min":[0,0,0]}]})";
}

class MeshMutation : public testing::Test {
 protected:
  void feed(const std::string& ending, const std::string& good, int count) {
    readOne(ending, good);
    feedMutations(good, count, [&](const std::string& bytes) { readOne(ending, bytes); });
    EXPECT_GT(read_, 0u);
    EXPECT_GT(refused_, 0u);
  }

 private:
  void readOne(const std::string& ending, const std::string& bytes) {
    const std::string path = scratch_.write("mutated" + ending, bytes);
    const auto start = Clock::now();
    try {
      const Mesh mesh = readMesh(path);
      ++read_;
      // What is in memory follows from what is in the file.
      EXPECT_LE(mesh.vertices.size() + mesh.triangles.size(), 40 * bytes.size() + 1000)
          << keep(bytes, ending);
      makeSolid(mesh, "mutated");
    } catch (const Error&) {
      ++refused_;
    }
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - start).count(), 5) << keep(bytes, ending);
  }

  // The file that failed, for whoever looks into it.
  static std::string keep(const std::string& bytes, const std::string& ending) {
    const std::string path = testing::TempDir() + "failed_mutation" + ending;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

  const Scratch scratch_;
  std::size_t read_ = 0, refused_ = 0;
};

constexpr int kMany = 1500;

Mesh seed() {
  return torusMesh(1, 0.4, 8, 6);
}

TEST_F(MeshMutation, Obj) {
  feed(".obj", objText(seed()), kMany);
}
TEST_F(MeshMutation, Off) {
  feed(".off", offText(seed()), kMany);
}
TEST_F(MeshMutation, PlyText) {
  feed(".ply", plyFile(seed(), false), kMany);
}
TEST_F(MeshMutation, PlyBinary) {
  feed(".ply", plyFile(seed(), true), kMany);
}
TEST_F(MeshMutation, StlText) {
  feed(".stl", stlText(seed()), kMany);
}
TEST_F(MeshMutation, StlBinary) {
  feed(".stl", stlBinary(seed()), kMany);
}
TEST_F(MeshMutation, Gzip) {
  feed(".obj.gz", gzipped(objText(seed())), kMany);
}
// Each in a child process.
TEST_F(MeshMutation, Gltf) {
  feed(".gltf", gltfText(), 40);
}

}  // namespace
}  // namespace innersphere::test

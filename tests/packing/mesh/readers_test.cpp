// The project's own readers: what files of each kind hold, and what is said of damaged ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "file_scratch.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "mesh_oracles.hpp"
#include "mesh_shapes.hpp"

namespace innersphere::test {
namespace {

template <class T>
void put(std::string& bytes, T value, bool big = false) {
  std::string raw(reinterpret_cast<const char*>(&value), sizeof value);
  if (big) std::reverse(raw.begin(), raw.end());
  bytes += raw;
}

std::string binaryStl(const Mesh& mesh, const std::string& header) {
  std::string bytes = header + std::string(80 - header.size(), ' ');
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) put(bytes, 0.0f);
    for (std::uint32_t v : t) {
      for (double x : mesh.vertices[v]) put(bytes, static_cast<float>(x));
    }
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

// With doubles, and properties that nobody asked for around the places.
std::string binaryPly(const Mesh& mesh, bool big) {
  std::string bytes =
      std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\r\ncomment by hand\r\nelement vertex " + std::to_string(mesh.vertices.size()) +
      "\r\nproperty uchar red\r\nproperty double x\r\nproperty double y\r\nproperty double z\r\n"
      "property list uchar short weights\r\nelement face " +
      std::to_string(mesh.triangles.size()) +
      "\r\nproperty list ushort uint vertex_index\r\nproperty float area\r\nend_header\r\n";
  for (const Vec3d& v : mesh.vertices) {
    put(bytes, std::uint8_t{7});
    for (double x : v) put(bytes, x, big);
    put(bytes, std::uint8_t{2});
    put(bytes, std::int16_t{1}, big);
    put(bytes, std::int16_t{2}, big);
  }
  for (const auto& t : mesh.triangles) {
    put(bytes, std::uint16_t{3}, big);
    for (std::uint32_t v : t) put(bytes, v, big);
    put(bytes, 0.5f, big);
  }
  return bytes;
}

void expectError(const std::string& path, ErrorCode code, const std::string& hint) {
  try {
    readMesh(path);
    ADD_FAILURE() << "no error for " << path;
  } catch (const Error& error) {
    EXPECT_STREQ(toString(error.code()), toString(code)) << error.what();
    EXPECT_NE(std::string(error.what()).find(path + ", " + hint), std::string::npos) << error.what();
  }
}

TEST(MeshReaders, BinaryFilesHoldTheBox) {
  const Scratch scratch;
  const Mesh box = boxMesh({1, 2, 3}, {2, 4, 6});
  for (const std::string& path :
       {scratch.write("a.stl", binaryStl(box, "by hand")),
        scratch.write("b.STL", binaryStl(box, "solid, but not a text")),
        scratch.write("c.ply", binaryPly(box, false)), scratch.write("d.ply", binaryPly(box, true))}) {
    const Mesh mesh = readMesh(path);
    EXPECT_EQ(mesh.vertices.size(), 8u) << path;
    EXPECT_TRUE(isClosedManifold(mesh)) << path;
    EXPECT_NEAR(volumeOf(mesh), 6, 1e-12) << path;
  }
}

// Some programs write more behind the last triangle.
TEST(MeshReaders, BytesBehindABinaryStlFileAreNoted) {
  const Scratch scratch;
  const Mesh box = boxMesh({1, 2, 3}, {2, 4, 6});
  for (const std::string header : {"by hand", "solid by hand", "solid\nby hand"}) {
    for (const std::string& behind :
         {std::string(10, '\0'), std::string("\r\n"), std::string("solid facet")}) {
      std::vector<std::string> notes;
      const Mesh mesh = readMesh(scratch.write("a.stl", binaryStl(box, header) + behind), {}, &notes);
      EXPECT_TRUE(isClosedManifold(mesh)) << header;
      EXPECT_NEAR(volumeOf(mesh), 6, 1e-12) << header;
      ASSERT_EQ(notes.size(), 1u) << header;
      EXPECT_NE(notes[0].find(std::to_string(behind.size()) + " bytes behind the 12 triangles"),
                std::string::npos)
          << notes[0];
    }
    std::vector<std::string> notes;
    readMesh(scratch.write("a.stl", binaryStl(box, header)), {}, &notes);
    EXPECT_TRUE(notes.empty());
    for (std::size_t size : {84, 300, 400, 600}) {
      expectError(scratch.write("cut.stl", binaryStl(box, header).substr(0, size)), ErrorCode::bad_format,
                  "byte 84: the file says that it has 12 triangles of 50 bytes, but " +
                      std::to_string(size - 84) + " bytes follow");
    }
  }
  std::string none = binaryStl(Mesh{}, "solid by hand");
  expectError(scratch.write("none.stl", none + std::string(50, '\0')), ErrorCode::bad_format, "byte 84");
}

// Zeros behind a text are no reason to take it for a binary file.
TEST(MeshReaders, TextStlFilesThatAreDamagedStayTexts) {
  const Scratch scratch;
  expectError(scratch.write("a.stl", "solid a\n" + std::string(100, ' ') + "\nfacet normal 0 0 1\n" +
                                         std::string(100, '\0')),
              ErrorCode::bad_format, "line 4");
  expectError(scratch.write("b.stl", "solid a\nfacte normal 0 0 1\n" + std::string(100, ' ')),
              ErrorCode::bad_format, "line 2");
}

// 0.1 and 1e5 + 1e-9 are no numbers of single precision.
TEST(MeshReaders, DoublesStayDoubles) {
  const Scratch scratch;
  const double x = 0.1, y = 100000.000000001, z = -1.2345678901234567e-30;
  std::ostringstream digits;
  digits.precision(17);
  digits << x << " " << y << " " << z;
  const std::string p = digits.str();
  const Mesh mesh{{{x, y, z}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const std::string head = "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n";
  for (const std::string& path :
       {scratch.write("a.obj", "v " + p + "\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        scratch.write("a.off", "OFF\n3 1 0\n" + p + "\n1 0 0\n0 1 0\n3 0 1 2\n"),
        scratch.write("a.stl", "solid\nfacet normal nan nan nan\nouter loop\nvertex " + p +
                                   "\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"),
        scratch.write("a.ply", "ply\nformat ascii 1.0\n" + head +
                                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                                   p + "\n1 0 0\n0 1 0\n3 0 1 2\n"),
        scratch.write("b.ply", binaryPly(mesh, false)), scratch.write("c.ply", binaryPly(mesh, true))}) {
    const Vec3d read = readMesh(path).vertices.at(0);
    EXPECT_EQ(read[0], x) << path;
    EXPECT_EQ(read[1], y) << path;
    EXPECT_EQ(read[2], z) << path;
  }
}

// As editors for Windows write it before a text in UTF-8.
TEST(MeshReaders, AByteOrderMarkIsNoPartOfTheText) {
  const Scratch scratch;
  const std::string mark = "\xEF\xBB\xBF",
                    head = "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n";
  for (const std::string& path :
       {scratch.write("a.obj", mark + "v 7 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        scratch.write("a.off", mark + "OFF\n3 1 0\n7 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        scratch.write("a.stl", mark + "solid\nfacet normal 0 0 1\nouter loop\nvertex 7 0 0\nvertex 1 0 0\n"
                                      "vertex 0 1 0\nendloop\nendfacet\nendsolid\n"),
        scratch.write("a.ply", mark + "ply\nformat ascii 1.0\n" + head +
                                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                                   "7 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")}) {
    const Mesh mesh = readMesh(path);
    ASSERT_EQ(mesh.vertices.size(), 3u) << path;
    EXPECT_EQ(mesh.vertices[0][0], 7) << path;
  }
}

// A star prism: its area is known, and a fan would leave the star.
TEST(MeshReaders, DentedPolygonsAreCutInside) {
  const Scratch scratch;
  constexpr int n = 14;
  std::ostringstream off;
  off.precision(17);
  off << "COFF # with colours\n" << 2 * n << " " << n + 2 << " 0\n";
  for (int i = 0; i < 2 * n; ++i) {
    const double r = i % 2 ? 1 : 0.3, angle = 2 * std::acos(-1.0) * (i % n) / n;
    off << r * std::cos(angle) << " " << r * std::sin(angle) << " " << i / n << " 255 0 0 255\n";
  }
  off << n;
  for (int i = n; i-- > 0;) off << " " << i;
  off << " 0.5 0.5 0.5\n" << n;
  for (int i = 0; i < n; ++i) off << " " << n + i;
  off << "\n";
  for (int i = 0; i < n; ++i)
    off << "4 " << i << " " << (i + 1) % n << " " << n + (i + 1) % n << " " << n + i << "\n";
  const Mesh mesh = readMesh(scratch.write("star.off", off.str()));
  EXPECT_EQ(mesh.triangles.size(), 2u * (n - 2) + 2 * n);
  EXPECT_TRUE(isClosedManifold(mesh));
  EXPECT_NEAR(volumeOf(mesh), n * 0.5 * 0.3 * std::sin(2 * std::acos(-1.0) / n), 1e-12);
  double area = 0;  // triangles that leave the star would add to it
  for (const auto& t : mesh.triangles) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (a[2] == b[2] && b[2] == c[2]) area += norm(cross(b - a, c - a)) / 2;
  }
  EXPECT_NEAR(area, 2 * volumeOf(mesh), 1e-12);
}

TEST(MeshReaders, ObjFacesCountForwardsAndBackwardsAndGoOnInTheNextLine) {
  const Scratch scratch;
  const Mesh mesh = readMesh(scratch.write("a.obj",
                                           "o one\r\nv 0 0 0 # corner\r\nv 2 0 0 2\r\nvt 0 0\r\n"
                                           "f -2/1/1 \\\r\n 2//1 3/1\r\nv 0 1 0 .5 .5 .5\r\n"));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.vertices.at(1)[0], 1);
  EXPECT_EQ(mesh.vertices.at(2)[1], 1);
}

TEST(MeshReaders, StripsAreTurnedEveryOtherTime) {
  const Scratch scratch;
  const Mesh mesh = readMesh(scratch.write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n9 0 1 2 3 -1 0 1 2 -1\n"));
  ASSERT_EQ(mesh.triangles.size(), 3u);
  for (const auto& t : mesh.triangles) {
    const Vec3d& a = mesh.vertices[t[0]];
    EXPECT_GT(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a)[2], 0);
  }
}

TEST(MeshReaders, CountsThatDoNotFitAreErrorsAtOnce) {
  const Scratch scratch;
  const std::string ply = "ply\nformat binary_little_endian 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string list = "property list uint int vertex_indices\n";
  std::string list_bytes(36, '\0');
  put(list_bytes, std::uint32_t{4000000000u});
  const std::vector<std::array<std::string, 3>> files{
      {"a.off", "OFF\n4000000000 1 0\n0 0 0\n", "line 2"},
      {"b.off", "OFF\n-1 1 0\n0 0 0\n", "line 2"},
      {"c.off", "OFF\n1 1 0\n0 0 0\n999999999 0 0 0\n", "line 4"},
      {"a.ply", ply + "element vertex 9223372036854775807\n" + xyz + "end_header\n", "line 7"},
      {"b.ply", ply + "element vertex 3\n" + xyz + "element face 1\n" + list + "end_header\n" + list_bytes,
       "byte "},
      {"c.ply", "ply\nformat", "line 2"},
      {"d.ply", ply + "element nothing 9223372036854775807\nelement vertex 1\n" + xyz + "end_header\n0123",
       "line 8"},
      {"a.stl", std::string(80, 'x') + "\xff\xff\xff\xff" + std::string(100, 'x'), "byte 84"},
      {"b.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", "line 5"},
      {"a.obj", "v 0 0 0\nv 1 0\n", "line 2"},
      {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1 2 9\n", "line 5"},
      {"c.obj", "v 0 0 0\nf -2 1 1\n", "line 2"},
      {"d.obj", "v 0 0 0x\n", "line 1"},
      {"e.obj", "nothing of this\nis a mesh", "line 1"},
      {"f.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nsurf 0 1 0 1\n", "line 4"}};
  for (const auto& [name, bytes, hint] : files) {
    expectError(scratch.write(name, bytes), ErrorCode::bad_format, hint);
  }
}

// A polygon like a comb with 20,000 teeth would take minutes if nothing held it back.
TEST(MeshReaders, PolygonsTooDentedToCutAreErrors) {
  const Scratch scratch;
  std::ostringstream obj;
  constexpr int n = 60000;
  for (int i = 0; i < n; ++i) obj << "v " << i << " " << (i % 2 ? 1 : 0) << " 0\n";
  obj << "v " << n << " -" << n << " 0\nv -1 -" << n << " 0\nf";
  for (int i = n + 2; i > 0; --i) obj << " " << i;
  obj << "\n";
  const std::string path = scratch.write("comb.obj", obj.str());
  try {
    EXPECT_EQ(readMesh(path).triangles.size(), static_cast<std::size_t>(n));
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("dents"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace innersphere::test

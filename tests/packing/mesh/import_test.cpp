// Files in, meshes out.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "file_scratch.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "mesh_oracles.hpp"
#include "mesh_shapes.hpp"

namespace innersphere::test {
namespace {

std::string objOf(const Mesh& mesh) {
  std::ostringstream out;
  for (const Vec3d& v : mesh.vertices) out << "v " << v[0] << " " << v[1] << " " << v[2] << "\n";
  for (const auto& t : mesh.triangles) out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  return out.str();
}

// With a normal for each facet, as STL files have, so that no two facets share a vertex.
std::string stlOf(const Mesh& mesh) {
  std::ostringstream out;
  out << "solid box\n";
  for (const auto& t : mesh.triangles) {
    out << "facet normal 0 0 1\nouter loop\n";
    for (std::uint32_t i : t) {
      const Vec3d& v = mesh.vertices[i];
      out << "vertex " << v[0] << " " << v[1] << " " << v[2] << "\n";
    }
    out << "endloop\nendfacet\n";
  }
  out << "endsolid box\n";
  return out.str();
}

std::string offOf(const Mesh& mesh) {
  std::ostringstream out;
  out << "OFF\n" << mesh.vertices.size() << " " << mesh.triangles.size() << " 0\n";
  for (const Vec3d& v : mesh.vertices) out << v[0] << " " << v[1] << " " << v[2] << "\n";
  for (const auto& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return out.str();
}

std::string plyOf(const Mesh& mesh) {
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& v : mesh.vertices) out << v[0] << " " << v[1] << " " << v[2] << "\n";
  for (const auto& t : mesh.triangles) out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
  return out.str();
}

std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned x = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      x = x << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (int k = 3; k >= 0; --k) out += digits[x >> (6 * k) & 63];
  }
  for (std::size_t k = 0; k < (3 - bytes.size() % 3) % 3; ++k) out[out.size() - 1 - k] = '=';
  return out;
}

// The indices and the vertices.
std::string gltfBuffer(const Mesh& mesh) {
  std::string buffer;
  const auto put = [&](const auto& x) { buffer.append(reinterpret_cast<const char*>(&x), sizeof x); };
  for (const auto& t : mesh.triangles) {
    for (std::uint32_t v : t) put(static_cast<std::uint16_t>(v));
  }
  for (const Vec3d& v : mesh.vertices) {
    for (double x : v) put(static_cast<float>(x));
  }
  return buffer;
}

// A unit box under the given nodes; the first node is the root. Its buffer is in the text, or in another
// part.
std::string gltfOf(const Mesh& mesh, const std::string& nodes, bool in_text = true) {
  const std::string buffer = gltfBuffer(mesh);
  const std::size_t indices = 3 * mesh.triangles.size() * sizeof(std::uint16_t);
  std::ostringstream out;
  out << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" << nodes
      << R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],"buffers":[{"byteLength":)"
      << buffer.size()
      << (in_text ? R"(,"uri":"data:application/octet-stream;base64,)" + base64(buffer) + '"' : std::string())
      << R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" << indices
      << R"(},{"buffer":0,"byteOffset":)" << indices << R"(,"byteLength":)" << buffer.size() - indices
      << R"(}],"accessors":[{"bufferView":0,"componentType":5123,"count":)" << 3 * mesh.triangles.size()
      << R"(,"type":"SCALAR"},{"bufferView":1,"componentType":5126,"count":)" << mesh.vertices.size()
      << R"(,"type":"VEC3","min":[-0.5,-0.5,-0.5],"max":[0.5,0.5,0.5]}]})";
  return out.str();
}

void expectError(const std::string& path, ErrorCode code, const std::string& hint,
                 const MeshOptions& options = {}) {
  try {
    readMesh(path, options);
    ADD_FAILURE() << "no error for " << path;
  } catch (const Error& error) {
    EXPECT_STREQ(toString(error.code()), toString(code)) << error.what();
    EXPECT_NE(std::string(error.what()).find(hint), std::string::npos) << error.what();
  }
}

TEST(MeshImport, EveryFormatGivesTheSameClosedBox) {
  const Scratch scratch;
  const Mesh box = boxMesh({1, 2, 3}, {2, 4, 6});
  const std::vector<std::pair<std::string, std::string>> files{
      {"box.obj", objOf(box)}, {"box.stl", stlOf(box)}, {"box.off", offOf(box)}, {"box.ply", plyOf(box)}};
  for (const auto& [name, bytes] : files) {
    const Mesh mesh = readMesh(scratch.write(name, bytes));
    EXPECT_EQ(mesh.vertices.size(), 8u) << name;
    EXPECT_TRUE(isClosedManifold(mesh)) << name;
    EXPECT_NEAR(volumeOf(mesh), 6, 1e-12) << name;
  }
}

TEST(MeshImport, PolygonsAreTriangulated) {
  const Scratch scratch;
  const std::string quads =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const Mesh mesh = readMesh(scratch.write("quads.obj", quads));
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_TRUE(isClosedManifold(mesh));
  EXPECT_NEAR(volumeOf(mesh), 1, 1e-12);
}

TEST(MeshImport, ScaleMultipliesCoordinates) {
  const Scratch scratch;
  MeshOptions options;
  options.scale = 0.001;
  const std::string path = scratch.write("box.obj", objOf(boxMesh({0, 0, 0}, {100, 200, 300})));
  EXPECT_NEAR(volumeOf(readMesh(path, options)), 0.006, 1e-12);
  for (const double scale : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    options.scale = scale;
    expectError(path, ErrorCode::bad_argument, "scale", options);
  }
}

/// A zip archive of these files, stored or deflated, written as the format's description says.
std::string zipOf(const std::vector<std::pair<std::string, std::string>>& files, bool deflated) {
  std::string out, directory;
  const auto put = [](std::string& to, std::uint32_t x, int bytes) {
    for (int k = 0; k < bytes; ++k) to += static_cast<char>(x >> 8 * k & 255);
  };
  for (const auto& [name, content] : files) {
    std::string data = content;
    if (deflated) {
      z_stream stream{};
      deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
      data.resize(deflateBound(&stream, content.size()));
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
      stream.avail_in = static_cast<uInt>(content.size());
      stream.next_out = reinterpret_cast<Bytef*>(data.data());
      stream.avail_out = static_cast<uInt>(data.size());
      deflate(&stream, Z_FINISH);
      data.resize(stream.total_out);
      deflateEnd(&stream);
    }
    std::string common;  // of both headers
    put(common, 20, 2), put(common, 0, 2), put(common, deflated ? 8 : 0, 2), put(common, 0, 4);
    put(common,
        static_cast<std::uint32_t>(
            crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()))),
        4);
    put(common, static_cast<std::uint32_t>(data.size()), 4);
    put(common, static_cast<std::uint32_t>(content.size()), 4);
    put(common, static_cast<std::uint32_t>(name.size()), 2), put(common, 0, 2);
    const auto offset = static_cast<std::uint32_t>(out.size());
    out += "PK\3\4" + common + name + data;
    directory += "PK\1\2";
    put(directory, 20, 2);
    directory += common;
    put(directory, 0, 2), put(directory, 0, 4), put(directory, 0, 4), put(directory, offset, 4);
    directory += name;
  }
  const auto begin = static_cast<std::uint32_t>(out.size()), count = static_cast<std::uint32_t>(files.size());
  out += directory + "PK\5\6";
  put(out, 0, 4), put(out, count, 2), put(out, count, 2);
  put(out, static_cast<std::uint32_t>(directory.size()), 4), put(out, begin, 4), put(out, 0, 2);
  return out;
}

std::string threeMfOf(const Mesh& mesh, const std::string& unit, bool deflated) {
  std::ostringstream model;
  model << "<?xml version=\"1.0\"?>\n<model" << unit
        << " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">"
           "<resources><object id=\"1\" type=\"model\"><mesh><vertices>";
  for (const Vec3d& v : mesh.vertices)
    model << "<vertex x=\"" << v[0] << "\" y=\"" << v[1] << "\" z=\"" << v[2] << "\"/>";
  model << "</vertices><triangles>";
  for (const auto& t : mesh.triangles)
    model << "<triangle v1=\"" << t[0] << "\" v2=\"" << t[1] << "\" v3=\"" << t[2] << "\"/>";
  model << "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>";
  const std::string relations =
      "<?xml version=\"1.0\"?><Relationships "
      "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
      "Target=\"/3D/3dmodel.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  return zipOf({{"_rels/.rels", relations}, {"3D/3dmodel.model", model.str()}}, deflated);
}

// Without a unit a 3MF file is in millimetres, as the format says.
TEST(MeshImport, ThreeMfComesInMetres) {
  const Scratch scratch;
  const Mesh box = boxMesh({0, 0, 0}, {1, 2, 3});
  const std::vector<std::pair<std::string, double>> units{{"", 1e-3},
                                                          {" unit=\"millimeter\"", 1e-3},
                                                          {" xml:lang='en'\n unit = 'meter'", 1},
                                                          {" unit=\"inch\"", 0.0254},
                                                          {" unit=\"micron\"", 1e-6}};
  for (const bool deflated : {false, true}) {
    for (const auto& [unit, metres] : units) {
      std::vector<std::string> notes;
      MeshOptions options;
      options.scale = 2;
      const Mesh mesh = readMesh(scratch.write("box.3mf", threeMfOf(box, unit, deflated)), options, &notes);
      EXPECT_NEAR(volumeOf(mesh) / (6 * std::pow(2 * metres, 3)), 1, 1e-6) << unit;
      EXPECT_EQ(notes.size(), metres == 1 ? 0u : 1u);
    }
    std::vector<std::string> notes;
    const std::string furlongs = threeMfOf(box, " unit=\"furlong\"", deflated);
    EXPECT_NEAR(volumeOf(readMesh(scratch.write("box.3mf", furlongs), {}, &notes)), 6, 1e-5);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_NE(notes[0].find("not known"), std::string::npos);
  }
}

// Two instances: one moved, scaled and turned by its parents, one mirrored, which has to be wound anew.
TEST(MeshImport, NodeTransformsAndMirrorsApply) {
  const Scratch scratch;
  const std::string nodes = R"([{"children":[1,3],"translation":[10,0,0]},)"
                            R"({"children":[2],"rotation":[0,0,0.70710678,0.70710678]},)"
                            R"({"mesh":0,"translation":[5,0,0],"scale":[2,1,1]},)"
                            R"({"mesh":0,"scale":[-1,1,3]}])";
  const Mesh mesh = readMesh(scratch.write("two.gltf", gltfOf(boxMesh(), nodes)));
  EXPECT_EQ(mesh.vertices.size(), 16u);
  EXPECT_TRUE(isClosedManifold(mesh));
  EXPECT_NEAR(volumeOf(mesh), 2 + 3, 1e-5);
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const Vec3d& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], v[k]);
      high[k] = std::max(high[k], v[k]);
    }
  }
  const Vec3d expected_low{9.5, -0.5, -1.5}, expected_high{10.5, 6, 1.5};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(low[k], expected_low[k], 1e-5);
    EXPECT_NEAR(high[k], expected_high[k], 1e-5);
  }
  MeshReport report;
  makeSolid(mesh, "two", {}, &report);
  EXPECT_EQ(report.components, 2u);
  EXPECT_TRUE(report.notes.empty());
}

std::string colladaOf(const Mesh& mesh, const std::string& up, double unit) {
  std::ostringstream out;
  out << R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">)"
      << "<asset><unit name=\"u\" meter=\"" << unit << "\"/><up_axis>" << up << "</up_axis></asset>"
      << R"(<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count=")"
      << 3 * mesh.vertices.size() << "\">";
  for (const Vec3d& v : mesh.vertices) out << v[0] << " " << v[1] << " " << v[2] << " ";
  out << R"(</float_array><technique_common><accessor source="#a" stride="3" count=")" << mesh.vertices.size()
      << R"("><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>)"
      << R"(</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>)"
      << R"(</vertices><triangles count=")" << mesh.triangles.size()
      << R"("><input semantic="VERTEX" source="#v" offset="0"/><p>)";
  for (const auto& t : mesh.triangles) out << t[0] << " " << t[1] << " " << t[2] << " ";
  out << "</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
      << R"(<visual_scene id="s"><node id="n"><translate>10 0 0</translate><rotate>0 0 1 90</rotate>)"
      << R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>)"
      << R"(<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  return out.str();
}

// As PyBullet and others read them: which axis is up changes nothing; units and nodes do.
TEST(MeshImport, ColladaKeepsTheAxesThatAreWritten) {
  const Scratch scratch;
  for (const std::string up : {"X_UP", "Y_UP", "Z_UP"}) {
    const Mesh mesh = readMesh(scratch.write(up + ".dae", colladaOf(boxMesh({0, 0, 0}, {1, 2, 4}), up, 0.5)));
    EXPECT_NEAR(volumeOf(mesh), 1, 1e-5) << up;
    Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
    for (const Vec3d& v : mesh.vertices) {
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], v[k]);
        high[k] = std::max(high[k], v[k]);
      }
    }
    const Vec3d expected_low{4, 0, 0}, expected_high{5, 0.5, 2};  // turned about z: x to y, y to -x
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(low[k], expected_low[k], 1e-5) << up;
      EXPECT_NEAR(high[k], expected_high[k], 1e-5) << up;
    }
  }
}

// A header with the size of all and two parts, of which the sizes may be told too large.
std::string glbOf(const Mesh& mesh, std::uint32_t more = 0, std::uint32_t more_in_part = 0) {
  std::string text = gltfOf(mesh, R"([{"mesh":0}])", false);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string buffer = gltfBuffer(mesh);
  std::string file;
  const auto put = [&](std::size_t x) {
    const auto word = static_cast<std::uint32_t>(x);
    file.append(reinterpret_cast<const char*>(&word), sizeof word);
  };
  file += "glTF";
  put(2);
  put(28 + text.size() + buffer.size() + more);
  put(text.size());
  file += "JSON" + text;
  put(buffer.size() + more_in_part);
  file.append("BIN\0", 4);
  return file + buffer;
}

TEST(MeshImport, BinaryGltfThatWasCutIsToldSo) {
  const Scratch scratch;
  const Mesh box = boxMesh();
  const std::string whole = glbOf(box);
  EXPECT_NEAR(volumeOf(readMesh(scratch.write("box.glb", whole))), 1, 1e-6);
  EXPECT_NEAR(volumeOf(readMesh(scratch.write("more.glb", whole + "more"))), 1, 1e-6);
  for (std::size_t left : {std::size_t{1}, std::size_t{4}, std::size_t{11}, std::size_t{12}, std::size_t{20},
                           whole.size() / 2, whole.size() - 1}) {
    expectError(scratch.write("cut.glb", whole.substr(0, left)), ErrorCode::bad_format, "was cut");
  }
  expectError(scratch.write("size.glb", glbOf(box, 1)), ErrorCode::bad_format, "byte 12: the file has");
  expectError(scratch.write("part.glb", glbOf(box, 0, 1)), ErrorCode::bad_format, "a part has");
  const std::string text = gltfOf(box, R"([{"mesh":0}])");
  expectError(scratch.write("cut.gltf", text.substr(0, text.size() / 2)), ErrorCode::bad_format, "damaged");
  expectError(scratch.write("no.glb", "this is not a mesh"), ErrorCode::bad_format, "damaged, or not what");
}

TEST(MeshImport, SaysWhatIsWrongWithAFile) {
  const Scratch scratch;
  expectError(scratch.path("none.obj"), ErrorCode::file_not_found, "none.obj");
  expectError(scratch.folder().string(), ErrorCode::file_not_found, "folder");
  expectError(scratch.write("empty.obj", ""), ErrorCode::empty_input, "empty.obj");
  expectError(scratch.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), ErrorCode::empty_input,
              "no triangles");
  expectError(scratch.write("text.stl", "this is not a mesh"), ErrorCode::bad_format, "text.stl");
  expectError(scratch.write("box.unknown", "this is not a mesh"), ErrorCode::bad_format, "OBJ");
  expectError(scratch.write("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), ErrorCode::bad_format,
              "range");
  expectError(scratch.write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n"), ErrorCode::not_finite,
              "vertex 1");
  expectError(scratch.write("inf.obj", "v 0 0 0\nv 1 1e60 0\nv 0 1 0\nf 1 2 3\n"), ErrorCode::not_finite,
              "vertex 1");
}

}  // namespace
}  // namespace innersphere::test

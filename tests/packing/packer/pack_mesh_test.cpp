// Triangles in memory to a packing, and what is kept of it on disk.
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <thread>

#include "file/packing_json.hpp"
#include "file_scratch.hpp"
#include "innersphere/error.hpp"
#include "innersphere/mesh.hpp"
#include "innersphere/pack_mesh.hpp"
#include "mesh_shapes.hpp"

namespace innersphere::test {
namespace {

namespace fs = std::filesystem;

/// Packs into a folder and notes whether it had to, and what was said.
struct Packer {
  Packing operator()(const Mesh& mesh, const std::string& name = "box") {
    messages.clear();
    packed = false;
    options.notice = [this](const std::string& message) { messages.push_back(message); };
    return packMesh(mesh, name, options, [this](const char*, double) { return packed = true; });
  }
  std::string file() const { return fs::directory_iterator(options.cache_folder)->path().string(); }

  PackMeshOptions options;
  bool packed = false;
  std::vector<std::string> messages;
};

Packer packerInto(const std::string& folder) {
  Packer packer;
  packer.options.pack = startUpOptions(5);
  packer.options.cache_folder = folder;
  return packer;
}

TEST(PackMesh, MeshFromArrays) {
  const float coordinates[] = {0, 1, 2, 3, 4, 5.5f, 6, 7, 8};
  const std::uint16_t indices[] = {0, 1, 2, 2, 1, 0};
  const Mesh mesh = meshFrom(coordinates, 3, indices, 2);
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[1], (Vec3d{3, 4, 5.5}));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{2, 1, 0}));
}

TEST(PackMesh, WithoutAFolderItPacksEachTime) {
  Packer packer = packerInto("");
  EXPECT_EQ(packer(boxMesh()).spheres.size(), 5u);
  EXPECT_TRUE(packer.packed);
  EXPECT_NEAR(packer(boxMesh()).solid.volume, 1, 1e-12);
  EXPECT_TRUE(packer.packed);
}

TEST(PackMesh, TheSecondCallReadsTheSameBits) {
  const Scratch scratch;
  Packer packer = packerInto(scratch.path("a/b"));
  const std::string first = toCbor(packer(boxMesh()));
  EXPECT_TRUE(packer.packed);
  const std::string second = toCbor(packer(boxMesh()));
  EXPECT_FALSE(packer.packed);
  EXPECT_EQ(first, second);
  EXPECT_TRUE(packer.messages.empty());
  const fs::directory_iterator files(packer.options.cache_folder);
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(PackMesh, TheNameAndTheThreadsDoNotCount) {
  const Scratch scratch;
  Packer packer = packerInto(scratch.folder());
  packer(boxMesh(), "one");
  packer.options.pack.threads = 1;
  EXPECT_EQ(packer(boxMesh(), "other").provenance.source, "other");
  EXPECT_FALSE(packer.packed);
}

TEST(PackMesh, AllElseCounts) {
  const Scratch scratch;
  Packer packer = packerInto(scratch.folder());
  packer(boxMesh());
  std::size_t files = 1;
  const auto expectPacked = [&](const Mesh& mesh, const char* what) {
    packer(mesh);
    EXPECT_TRUE(packer.packed) << what;
    EXPECT_EQ(scratch.files(), ++files) << what;
  };
  Mesh nudged = boxMesh();
  nudged.vertices[0][0] = std::nextafter(nudged.vertices[0][0], 0.0);
  expectPacked(nudged, "a vertex");
  Mesh turned = boxMesh();
  turned.triangles[0] = {2, 1, 0};  // the same triangle
  expectPacked(turned, "the order");
  packer.options.pack.delta = 0.2;
  expectPacked(boxMesh(), "delta");
  packer.options.pack.spheres = 6;
  expectPacked(boxMesh(), "spheres");
  packer.options.pack.gap = 0.4;
  expectPacked(boxMesh(), "gap");
  packer.options.pack.min_radius = 1e-3;
  expectPacked(boxMesh(), "min_radius");
  packer.options.pack.density = 0.9;
  expectPacked(boxMesh(), "density");
  packer.options.repair = true;
  expectPacked(boxMesh(), "repair");
}

TEST(PackMesh, ADamagedFileIsReplaced) {
  const Scratch scratch;
  Packer packer = packerInto(scratch.folder());
  const std::string right = toCbor(packer(boxMesh()));
  const std::string file = packer.file(), bytes = bytesOf(file);
  std::vector<std::string> damaged = {"", "\n", bytes + "x"};
  for (const double part : {0.0005, 0.01, 0.3, 0.7, 0.99}) {
    const std::size_t place = static_cast<std::size_t>(part * double(bytes.size()));
    damaged.push_back(bytes.substr(0, place));
    damaged.push_back(bytes);
    damaged.back()[place] ^= 1;  // most of these make another valid packing
  }
  for (const std::string& wrong : damaged) {
    scratch.write(fs::path(file).filename(), wrong);
    EXPECT_EQ(toCbor(packer(boxMesh())), right);
    EXPECT_TRUE(packer.packed);
    ASSERT_EQ(packer.messages.size(), 1u);
    EXPECT_NE(packer.messages[0].find("packed anew"), std::string::npos);
    EXPECT_EQ(bytesOf(file), bytes);
  }
}

TEST(PackMesh, AFileOfSomethingElseIsReplaced) {
  const Scratch scratch, elsewhere;
  Packer packer = packerInto(scratch.folder()), other = packerInto(elsewhere.folder());
  const std::string right = toCbor(packer(boxMesh()));
  other(boxMesh({0, 0, 0}, {1, 2, 3}));
  fs::copy_file(other.file(), packer.file(), fs::copy_options::overwrite_existing);
  EXPECT_EQ(toCbor(packer(boxMesh())), right);
  EXPECT_TRUE(packer.packed);
  EXPECT_EQ(packer.messages.size(), 1u);
  packer(boxMesh());
  EXPECT_FALSE(packer.packed);
}

TEST(PackMesh, AFolderThatCannotBeWrittenToIsSaid) {
  const Scratch scratch;
  Packer packer = packerInto(scratch.write("file", "x") + "/cache");
  for (int call = 0; call < 2; ++call) {
    EXPECT_EQ(packer(boxMesh()).spheres.size(), 5u);
    EXPECT_TRUE(packer.packed);
    ASSERT_EQ(packer.messages.size(), 1u);
    EXPECT_NE(packer.messages[0].find("not kept"), std::string::npos);
  }
  EXPECT_EQ(scratch.files(), 1u);
}

TEST(PackMesh, WhatWasMendedIsInTheWarnings) {
  const Scratch scratch;
  Packer packer = packerInto(scratch.folder());
  MeshReport report;
  makeSolid(inverted(boxMesh()), "box", {}, &report);
  ASSERT_FALSE(report.notes.empty());
  for (const bool packed : {true, false}) {
    const Packing packing = packer(inverted(boxMesh()));
    EXPECT_EQ(packer.packed, packed);
    ASSERT_GE(packing.warnings.size(), report.notes.size());
    EXPECT_EQ(packing.warnings[0], report.notes[0]);
  }
}

TEST(PackMesh, ErrorsLeaveNoFile) {
  const Scratch scratch;
  Packer packer = packerInto(scratch.folder());
  Mesh open = boxMesh();
  open.triangles.pop_back();
  const auto codeOf = [&](const Mesh& mesh) -> std::optional<ErrorCode> {
    try {
      packer(mesh);
    } catch (const Error& error) {
      return error.code();
    }
    return std::nullopt;
  };
  EXPECT_EQ(codeOf(open), ErrorCode::not_a_solid);
  packer.options.pack.delta = 7;
  EXPECT_EQ(codeOf(boxMesh()), ErrorCode::bad_argument);
  packer.options.pack.delta = 0.1;
  EXPECT_THROW(packMesh(boxMesh(), "box", packer.options, [](const char*, double) { return false; }), Error);
  EXPECT_EQ(scratch.files(), 0u);
  packer.options.repair = true;
  EXPECT_EQ(codeOf(open), std::nullopt);
}

TEST(PackMesh, ThreadsCanShareAFolder) {
  const Scratch scratch;
  Packer first = packerInto(scratch.folder()), second = first;
  std::string a, b;
  std::thread beside([&] { a = toCbor(first(boxMesh())); });
  b = toCbor(second(boxMesh()));
  beside.join();
  EXPECT_EQ(a, b);
  EXPECT_TRUE(first.messages.empty() && second.messages.empty());
  EXPECT_EQ(scratch.files(), 1u);
}

TEST(PackMesh, DefaultFolderFollowsTheEnvironment) {
  const auto kept = [](const char* name) -> std::optional<std::string> {
    const char* value = std::getenv(name);
    return value == nullptr ? std::nullopt : std::optional<std::string>(value);
  };
  const auto xdg = kept("XDG_CACHE_HOME"), home = kept("HOME");
  const auto set = [](const char* name, const std::optional<std::string>& value) {
    value ? setenv(name, value->c_str(), 1) : unsetenv(name);
  };
  set("HOME", "/home/someone");
  set("XDG_CACHE_HOME", "/elsewhere");
  EXPECT_EQ(defaultCacheFolder(), "/elsewhere/innersphere");
  set("XDG_CACHE_HOME", "");
  EXPECT_EQ(defaultCacheFolder(), "/home/someone/.cache/innersphere");
  set("XDG_CACHE_HOME", std::nullopt);
  set("HOME", std::nullopt);
  EXPECT_EQ(defaultCacheFolder(), "");
  set("XDG_CACHE_HOME", xdg);
  set("HOME", home);
}

}  // namespace
}  // namespace innersphere::test

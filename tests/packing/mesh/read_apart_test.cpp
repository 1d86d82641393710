// A reader that crashes, hangs, or takes all memory is an error of the file, and of nothing else.
#include "mesh/import/read_apart.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <vector>

#include "innersphere/error.hpp"
#include "mesh_shapes.hpp"

namespace innersphere::test {
namespace {

std::string errorOf(Mesh (*read)(const std::string&), ErrorCode code) {
  try {
    readApart(read, "some.file");
  } catch (const Error& error) {
    EXPECT_STREQ(toString(error.code()), toString(code)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return {};
}

TEST(MeshReadApart, MeshesAndErrorsComeBack) {
  const Mesh mesh = readApart([](const std::string&) { return boxMesh({1, 2, 3}, {2, 4, 6}); }, "some.file");
  const Mesh expected = boxMesh({1, 2, 3}, {2, 4, 6});
  EXPECT_EQ(mesh.triangles, expected.triangles);
  ASSERT_EQ(mesh.vertices.size(), expected.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.vertices[i][k], expected.vertices[i][k]);
  }
  EXPECT_EQ(errorOf([](const std::string& path) -> Mesh { throw Error(ErrorCode::not_finite, path + "!"); },
                    ErrorCode::not_finite),
            "some.file!");
}

TEST(MeshReadApart, CrashesAreErrors) {
  for (const auto read : {+[](const std::string&) -> Mesh { std::raise(SIGSEGV), std::abort(); },
                          +[](const std::string&) -> Mesh { std::abort(); }}) {
    EXPECT_NE(errorOf(read, ErrorCode::bad_format).find("crashed"), std::string::npos);
  }
  EXPECT_NE(errorOf([](const std::string&) -> Mesh { _exit(0); }, ErrorCode::bad_format).find("answer"),
            std::string::npos);
  errorOf([](const std::string&) -> Mesh { std::raise(SIGTERM), std::abort(); }, ErrorCode::cancelled);
}

TEST(MeshReadApart, HangsEndWithinFiveSeconds) {
  const auto start = std::chrono::steady_clock::now();
  const auto hang = [](const std::string&) -> Mesh {
    while (true) pause();
  };
  EXPECT_NE(errorOf(hang, ErrorCode::bad_format).find("4 s"), std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(MeshReadApart, MemoryIsLimited) {
  const auto hoard = [](const std::string&) {
    Mesh mesh;
    while (true) mesh.vertices.resize(2 * mesh.vertices.size() + 1'000'000);
    return mesh;
  };
  errorOf(hoard, ErrorCode::bad_format);
}

TEST(MeshReadApart, NoChildIsLeft) {
  errno = 0;
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace innersphere::test

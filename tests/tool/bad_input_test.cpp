// What users get wrong: the message names it, the exit status says what kind it is, and nothing is left
// behind.
#include <chrono>
#include <filesystem>

#include "meshes.hpp"
#include "tool_runner.hpp"

namespace innersphere::test {
namespace {

class BadInput : public ToolTest {};

TEST_F(BadInput, Meshes) {
  writeFile(path("empty.obj"), "");
  writeFile(path("points.obj"), "v 0 0 0\nv 1 0 0\n");
  writeFile(path("open.obj"), kOpenTetrahedron);
  writeFile(path("nan.obj"), "v 0 0 0\nv nan 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  writeFile(path("noise.stl"), "this is not a mesh");
  std::filesystem::create_directory(path("folder.obj"));
  const auto expect = [this](const std::string& mesh, const std::vector<std::string>& words) {
    refuse("pack " + mesh + " --spheres 5 -o out.json", 3, words);
    refuse("scene run pile --spheres 5 --seconds 0.1 --mesh " + mesh + " --csv out.csv --png out.png", 3,
           words);
  };
  expect("missing.obj", {"missing.obj", "file_not_found"});
  expect("nosuchsolid", {"nosuchsolid", "innersphere solids"});
  expect("empty.obj", {"empty.obj"});
  expect("points.obj", {"points.obj"});
  expect("open.obj", {"open.obj", "open edges", "repair", "not_a_solid"});
  expect("nan.obj", {"nan.obj", "not_finite"});
  expect("noise.stl", {"noise.stl"});
  expect("folder.obj", {"folder.obj"});
}

TEST_F(BadInput, AnOpenMeshIsPackedOnlyWhenAskedFor) {
  writeFile(path("open.obj"), kOpenTetrahedron);
  const Outcome outcome = run("pack open.obj --repair --spheres 5 -o open.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("open.obj"), std::string::npos) << "says nothing about the holes";
}

TEST_F(BadInput, Packings) {
  writeFile(path("empty.json"), "");
  writeFile(path("noise.cbor"), std::string("\xff\x00\x13\x37", 4));
  writeFile(path("other.json"), "{\"colour\": \"red\"}");
  writeFile(path("nan.xyzr"), "0 0 0 nan\n");
  writeFile(path("words.xyzr"), "0 0 zero 1\n");
  writeFile(path("packing.doc"), "0 0 0 1\n");
  for (const std::string command : {"info ", "check ", "view --png out.png "}) {
    for (const std::string file :
         {"missing.json", "empty.json", "noise.cbor", "other.json", "nan.xyzr", "words.xyzr"}) {
      refuse(command + file, 3, {file});
    }
  }
  refuse("info packing.doc", 3, {"doc", ".cbor"});
  // A name without an ending.
  writeFile(path("packing"), "0 0 0 1\n");
  refuse("info packing", 3, {"packing is no packing", ".cbor"});
  refuse("convert other.json out.cbor", 3, {"other.json"});
}

TEST_F(BadInput, OutputsThatCannotBeWritten) {
  std::filesystem::create_directory(path("folder.json"));
  refuse("pack box --spheres 5 -o nowhere/box.json", 5, {"nowhere"});
  refuse("pack box --spheres 5 -o folder.json --force", 5, {"folder"});
  writeFile(path("old.png"), "precious");
  refuse("view box --spheres 5 --png old.png --html new.html", 5, {"old.png", "--force"});
  refuse("scene run stack --spheres 5 --seconds 0.1 --csv new.csv --html old.png", 5, {"old.png", "--force"});
  EXPECT_EQ(readFile(path("old.png")), "precious");
}

TEST_F(BadInput, PicturesOfAnotherEnding) {
  for (const std::string command : {"view box --spheres 5 ", "scene run stack --spheres 5 --seconds 0.1 "}) {
    for (const std::string name : {"box.jpg", "box", "png"}) {
      refuse(command + "--html box.html --png " + name, 2, {name, ".png"});
    }
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(BadInput, PoseTables) {
  const std::string header = "m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n";
  writeFile(path("b.xyzr"), "0 0 0 1\n");
  writeFile(path("empty.csv"), "");
  writeFile(path("header.csv"), header);
  writeFile(path("short.csv"), "m00,m01\n1,0\n");
  writeFile(path("words.csv"), header + "1,0,0,0,0,1,0,0,0,0,1,0\n1,0,0,far,0,1,0,0,0,0,1,0\n");
  writeFile(path("ragged.csv"), header + "1,0,0,0\n");
  writeFile(path("surplus.csv"), header + "1,0,0,0,0,1,0,0,0,0,1,0\n1,0,0,0,0,1,0,0,0,0,1,0,0,9\n");
  writeFile(path("nan.csv"), header + "1,0,0,nan,0,1,0,0,0,0,1,0\n");
  writeFile(path("scaled.csv"), header + "2,0,0,0,0,2,0,0,0,0,2,0\n");
  writeFile(path("mirror.csv"), header + "-1,0,0,0,0,1,0,0,0,0,1,0\n");
  const auto expect = [this](const std::string& poses, const std::vector<std::string>& words) {
    refuse("overlap b.xyzr b.xyzr --poses " + poses + " -o out.csv", 3, words);
  };
  expect("missing.csv", {"missing.csv"});
  expect("empty.csv", {"empty.csv"});
  expect("header.csv", {"header.csv"});
  expect("short.csv", {"short.csv", "m02"});
  expect("words.csv", {"words.csv", "line 3", "far"});
  expect("ragged.csv", {"ragged.csv", "line 2"});
  expect("surplus.csv", {"surplus.csv", "line 3", "14 fields", "12 columns"});
  expect("nan.csv", {"nan.csv", "line 2"});
  expect("scaled.csv", {"scaled.csv", "line 2", "scale"});
  expect("mirror.csv", {"mirror.csv", "line 2", "mirror"});
}

// So many parts are judged for seconds. The sleep lets that begin.
TEST_F(BadInput, SignalsEndReadingWithinASecond) {
  std::string crowd;
  for (int i = 0; i < 40000; ++i) {
    const std::string x = std::to_string(2 * i), y = std::to_string(2 * i + 1);
    crowd += "v " + x + " 0 0\nv " + y + " 0 0\nv " + x + " 1 0\nv " + x +
             " 0 1\nf -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n";
  }
  writeFile(path("crowd.obj"), crowd);
  for (const std::string signal : {"INT", "TERM"}) {
    const auto start = std::chrono::steady_clock::now();
    const Outcome outcome = shell("\"$TOOL\" pack crowd.obj -o out.cbor & tool=$!; sleep 0.5; kill -" +
                                  signal + " $tool; wait $tool");
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(1500));
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("cancelled"), std::string::npos) << outcome.err;
    EXPECT_EQ(files().count("out.cbor"), 0u);
  }
}

// A file system without free space.
TEST_F(BadInput, LostOutputIsAFailure) {
  succeed("pack box --spheres 5 -o box.cbor");
  for (const std::string command :
       {"info box.cbor", "info box.cbor --json", "check box.cbor", "solids", "solids --json", "scene list",
        "--version", "--help", "pack --help", "--help-all", "help pack", "convert box.cbor -",
        "pack box --spheres 5 -o new.cbor --force", "scene run slide --spheres 5 --seconds 0.01",
        "scene check slide --spheres 5 --seconds 0.01"}) {
    const Outcome outcome = run(command + " > /dev/full");
    EXPECT_EQ(outcome.exit_code, 5) << command << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find("stdout"), std::string::npos) << command << "\n" << outcome.err;
  }
}

}  // namespace
}  // namespace innersphere::test

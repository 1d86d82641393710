// pack, info, check and convert.
#include <algorithm>

#include "meshes.hpp"
#include "tool_runner.hpp"

namespace innersphere::test {
namespace {

class PackingCommands : public ToolTest {};

TEST_F(PackingCommands, PackInfoAndCheckAgree) {
  const auto summary = json("pack box --spheres 100 -o box.json");
  EXPECT_EQ(summary["spheres"], 100);
  EXPECT_NEAR(summary["volume"].get<double>(), 1, 1e-12);
  EXPECT_GT(summary["density"].get<double>(), 0.6);
  EXPECT_LT(summary["density"].get<double>(), 0.9);
  EXPECT_EQ(json("info box.json"), summary);

  const auto verdict = json("check box.json --mesh box");
  EXPECT_EQ(verdict["valid"], true);
  EXPECT_NEAR(verdict["density"].get<double>(), summary["density"].get<double>(), 1e-6);
}

TEST_F(PackingCommands, PacksAMeshFileAtAScale) {
  writeFile(path("tetra.obj"), kTetrahedron);
  const auto summary = json("pack tetra.obj --scale 0.001 --spheres 20 -o tetra.cbor");
  EXPECT_EQ(summary["spheres"], 20);
  EXPECT_NEAR(summary["volume"].get<double>() * 6e9, 1, 1e-6);
  EXPECT_EQ(json("check tetra.cbor --mesh tetra.obj --scale 0.001")["valid"], true);
  // Against the mesh at its own size the spheres are just as well inside, against one of half the size they
  // are not.
  const Outcome outcome = run("check tetra.cbor --mesh tetra.obj --scale 0.0005");
  EXPECT_EQ(outcome.exit_code, 1);
}

TEST_F(PackingCommands, ReportsForPeopleGoToStandardOutput) {
  const Outcome outcome = succeed("pack box --spheres 10 -o box.json");
  EXPECT_NE(outcome.out.find("density"), std::string::npos);
}

TEST_F(PackingCommands, CheckFindsOverlapsAndSaysWhere) {
  writeFile(path("bad.xyzr"), "0 0 0 1\n5 0 0 1\n6.5 0 0 0.75\n");
  const Outcome outcome = run("check bad.xyzr --json");
  EXPECT_EQ(outcome.exit_code, 1);
  const auto verdict = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(verdict["valid"], false);
  EXPECT_NEAR(verdict["worst_overlap"].get<double>(), 0.25, 1e-6);
  auto pair = verdict["overlap_spheres"].get<std::vector<int>>();
  std::sort(pair.begin(), pair.end());
  EXPECT_EQ(pair, (std::vector<int>{1, 2}));
}

TEST_F(PackingCommands, ConvertKeepsThePacking) {
  succeed("pack torus --spheres 64 -o torus.json");
  succeed("convert torus.json torus.cbor");
  succeed("convert torus.cbor again.json");
  EXPECT_EQ(readFile(path("again.json")), readFile(path("torus.json")));
  succeed("convert torus.cbor torus.ply");
  EXPECT_EQ(readFile(path("torus.ply")).substr(0, 3), "ply");
  succeed("convert torus.cbor torus.xyzr");
  EXPECT_EQ(json("info torus.xyzr")["spheres"], 64);
}

TEST_F(PackingCommands, ReplacesOnlyWithForce) {
  writeFile(path("box.json"), "precious");
  refuse("pack box --spheres 10 -o box.json", 5, {"box.json", "--force"});
  EXPECT_EQ(readFile(path("box.json")), "precious");
  succeed("pack box --spheres 10 -o box.json --force");
  EXPECT_EQ(json("info box.json")["spheres"], 10);
  refuse("convert box.json box.json", 5, {"--force"});
}

TEST_F(PackingCommands, TheSameBytesForAnyNumberOfThreads) {
  // More threads than cores make oneTBB warn on stderr.
  EXPECT_EQ(run("pack torus --spheres 200 --threads 1 -o one.json").exit_code, 0);
  EXPECT_EQ(run("pack torus --spheres 200 --threads 4 -o four.json").exit_code, 0);
  EXPECT_EQ(readFile(path("one.json")), readFile(path("four.json")));
}

TEST_F(PackingCommands, InterruptCancelsAndLeavesNothing) {
  const Outcome outcome =
      shell("\"$TOOL\" pack gear --spheres 5000000 -o gear.cbor & sleep 1; kill -INT $!; wait $!");
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_NE(outcome.err.find("cancelled"), std::string::npos) << outcome.err;
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace innersphere::test

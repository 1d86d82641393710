// pack, info, check and convert.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "meshes.hpp"
#include "tool_runner.hpp"

namespace innersphere::test {
namespace {

namespace fs = std::filesystem;

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

TEST_F(PackingCommands, TheAccuracySetsTheNumberOfSpheres) {
  const Outcome outcome = run("pack box --accuracy 0.04 --json -o box.json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_NE(outcome.err.find("4.00 % of the diagonal"), std::string::npos) << outcome.err;
  const auto summary = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(summary["order"], "coverage");
  EXPECT_LE(summary["gap_max"].get<double>(), 0.04 * std::sqrt(3.0));
  const auto spheres = summary["spheres"].get<std::size_t>();
  EXPECT_EQ(summary["coverage"].back()["count"], spheres);
  const auto fewer =
      json("pack box --order coverage --spheres " + std::to_string(spheres - 1) + " -o few.json");
  EXPECT_GT(fewer["gap_max"].get<double>(), 0.04 * std::sqrt(3.0));
  EXPECT_EQ(json("check few.json --mesh box")["valid"], true);
  EXPECT_EQ(json("pack box --spheres 50 -o fifty.json")["order"], "radius");
}

TEST_F(PackingCommands, PacksTheBodiesOfAFileForThemselves) {
  std::string two = kTetrahedron;
  two += "v 5 0 0\nv 7 0 0\nv 5 2 0\nv 5 0 2\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n";
  writeFile(path("two.obj"), two);
  const Outcome outcome = run("pack two.obj --split --spheres 20");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(files(), (std::set<std::string>{"two.obj", "two-1.cbor", "two-2.cbor"}));
  EXPECT_NEAR(json("info two-1.cbor")["volume"].get<double>(), 1.0 / 6, 1e-9);
  EXPECT_NEAR(json("info two-2.cbor")["volume"].get<double>(), 8.0 / 6, 1e-9);
  refuse("pack two.obj --split -o -", 2, {"--split"});
  refuse("pack two.obj --split", 5, {"two-1.cbor", "exists"});
}

TEST_F(PackingCommands, ReadsCompressedMeshes) {
  writeFile(path("tetra.obj"), kTetrahedron);
  ASSERT_EQ(shell("gzip tetra.obj").exit_code, 0);
  EXPECT_EQ(run("pack tetra.obj.gz --spheres 20").exit_code, 0);
  EXPECT_EQ(json("check tetra.cbor --mesh tetra.obj.gz")["valid"], true);
  ASSERT_EQ(shell("head -c 60 tetra.obj.gz > cut.obj.gz; gzip -c tetra.cbor > thing.gltf.gz").exit_code, 0);
  refuse("pack cut.obj.gz --force", 3, {"cut.obj.gz", "cut"});
  refuse("pack thing.gltf.gz --force", 3, {"thing.gltf.gz", "unpack"});
}

TEST_F(PackingCommands, SaysAtOnceThatASheetIsTooThin) {
  writeFile(path("sheet.obj"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1e-6\nv 1 0 1e-6\nv 0 1 1e-6\nv 1 1 1e-6\n"
            "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n");
  refuse("pack sheet.obj -o sheet.cbor", 3, {"it is a sheet or a rod", "thicker", "--min-radius"});
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
  const std::string table = succeed("info torus.xyzr").out;
  EXPECT_NE(table.find("volume of the spheres"), std::string::npos) << table;
  EXPECT_EQ(table.find("of the solid"), std::string::npos) << table;
}

TEST_F(PackingCommands, ReplacesOnlyWithForce) {
  writeFile(path("box.json"), "precious");
  refuse("pack box --spheres 10 -o box.json", 5, {"box.json", "--force"});
  EXPECT_EQ(readFile(path("box.json")), "precious");
  succeed("pack box --spheres 10 -o box.json --force");
  EXPECT_EQ(json("info box.json")["spheres"], 10);
  refuse("convert box.json box.json", 5, {"--force"});
}

TEST_F(PackingCommands, ForceWritesThroughALinkAndKeepsPermissions) {
  for (const std::string make :
       {"pack box --spheres 10 --force -o link.json",
        "view box --spheres 10 --width 16 --height 16 --samples 1 --force --png link.png"}) {
    const std::string link = make.substr(make.rfind(' ') + 1), real = "elsewhere/" + link;
    fs::create_directory(path("elsewhere"));
    writeFile(path(real), "old");
    fs::permissions(path(real), fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink(real, path("middle"));
    fs::create_symlink("middle", path(link));
    refuse(make.substr(0, make.find(" --force")) + make.substr(make.find(" --force") + 8), 5, {link});
    EXPECT_EQ(readFile(path(real)), "old");
    EXPECT_EQ(run(make).exit_code, 0) << make;
    EXPECT_EQ(fs::read_symlink(path(link)), "middle");
    EXPECT_EQ(fs::read_symlink(path("middle")), real);
    EXPECT_GT(readFile(path(real)).size(), 50u);
    EXPECT_EQ(fs::status(path(real)).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(files(), (std::set<std::string>{"elsewhere", link, "middle"}));
    for (const std::string& name : files()) fs::remove_all(path(name));
  }
}

TEST_F(PackingCommands, ALinkThatLeadsNowhereIsFollowed) {
  fs::create_symlink("real.json", path("link.json"));
  refuse("pack box --spheres 10 -o link.json", 5, {"link.json", "--force"});
  succeed("pack box --spheres 10 -o link.json --force");
  EXPECT_TRUE(fs::is_symlink(path("link.json")));
  EXPECT_EQ(json("info real.json")["spheres"], 10);
}

TEST_F(PackingCommands, DevicesAreNotReplaced) {
  succeed("pack box --spheres 10 -o /dev/null");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  refuse("pack box --spheres 10 -o /dev/full", 5, {"/dev/full"});
}

TEST_F(PackingCommands, FilesThatMayNotGrowSoLargeAreFailures) {
  const Outcome outcome = shell("ulimit -f 1; \"$TOOL\" pack box --spheres 300 -o box.json");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
  EXPECT_NE(outcome.err.find("box.json"), std::string::npos) << outcome.err;
  EXPECT_TRUE(files().empty());
}

// oneTBB itself complains of more threads than it gives.
TEST_F(PackingCommands, MoreThreadsThanCoresAreNothingToSay) {
  for (const std::string kind : {"", " --cover", " --clump"}) {
    succeed("pack box --spheres 16 --threads 4000 --force -o many.json" + kind);
    succeed("pack box --spheres 16 --threads 1 --force -o one.json" + kind);
    EXPECT_EQ(readFile(path("many.json")), readFile(path("one.json"))) << kind;
  }
}

TEST_F(PackingCommands, WithoutOutputItIsNamedAfterTheSolid) {
  fs::create_directory(path("folder"));
  writeFile(path("folder/tetra.obj"), kTetrahedron);
  EXPECT_EQ(json("pack folder/tetra.obj --spheres 10")["spheres"], 10);
  EXPECT_EQ(json("info tetra.cbor")["spheres"], 10);
  EXPECT_NE(run("pack ball").err.find("ball.cbor"), std::string::npos) << "says where it is";
  refuse("pack ball", 5, {"ball.cbor", "--force"});
}

TEST_F(PackingCommands, PipesCarryPackings) {
  succeed("pack torus --spheres 20 -o torus.json");
  const auto summary = json("info torus.json");
  // Each format is known by its content.
  for (const std::string format : {"json", "cbor"}) {
    for (const std::string from : {"info - --json", "info /dev/stdin --json"}) {
      const Outcome outcome =
          shell("\"$TOOL\" convert torus.json - --format " + format + " | \"$TOOL\" " + from);
      EXPECT_EQ(nlohmann::json::parse(outcome.out, nullptr, false), summary) << outcome.err;
    }
  }
  const Outcome spheres = shell("\"$TOOL\" convert torus.json - --format xyzr | \"$TOOL\" info - --json");
  EXPECT_EQ(nlohmann::json::parse(spheres.out, nullptr, false)["spheres"], 20) << spheres.err;
  EXPECT_EQ(nlohmann::json::parse(spheres.out, nullptr, false)["source"], "stdin");
  // The packing alone is on stdout, the report is on stderr.
  const Outcome packed = run("pack torus --spheres 20 -o -");
  EXPECT_EQ(packed.out, readFile(path("torus.json")));
  EXPECT_NE(packed.err.find("density"), std::string::npos);
  const Outcome noise = shell("echo '{\"colour\": 1}' | \"$TOOL\" info -");
  EXPECT_EQ(noise.exit_code, 3);
  EXPECT_EQ(noise.err.find("innersphere: stdin"), 0u) << noise.err;
  refuse("info -", 3, {"stdin"});
  refuse("pack -", 3, {"stdin", "empty"});
  EXPECT_EQ(files(), std::set<std::string>{"torus.json"});
}

TEST_F(PackingCommands, PipesCarryMeshes) {
  writeFile(path("tetra.obj"), "# a comment\n" + std::string(kTetrahedron));
  succeed("pack tetra.obj --spheres 20 -o tetra.cbor");
  succeed("convert tetra.cbor tetra.stl");
  for (const std::string file : {"tetra.obj", "tetra.stl"}) {
    const Outcome outcome = shell("\"$TOOL\" pack - --spheres 20 --json -o piped.cbor --force < " + file);
    ASSERT_EQ(outcome.exit_code, 0) << file << outcome.err;
    const auto summary = nlohmann::json::parse(outcome.out);
    EXPECT_NEAR(summary["volume"].get<double>(), 1.0 / 6, 1e-6) << file;
    EXPECT_EQ(summary["source"], "stdin");
  }
  EXPECT_EQ(shell("cat tetra.obj | \"$TOOL\" pack /dev/stdin --spheres 9 -o x.cbor").exit_code, 0);
  EXPECT_NE(shell("gzip -c tetra.obj | \"$TOOL\" pack - -o y.cbor").err.find("gunzip"), std::string::npos);
  EXPECT_EQ(shell("echo nonsense | \"$TOOL\" pack - -o y.cbor").exit_code, 3);
}

TEST_F(PackingCommands, QuietKeepsTheReportOffStandardError) {
  const Outcome quiet = run("pack torus --spheres 20 -o - -q");
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.err, "");
  EXPECT_EQ(quiet.out, run("pack torus --spheres 20 -o -").out);
}

TEST_F(PackingCommands, PlacesHaveTheDigitsThatTellThemApart) {
  writeFile(path("far.obj"),
            "v 1000000 0 0\nv 1000001 0 0\nv 1000000 1 0\nv 1000000 0 1\n"
            "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const std::string table = succeed("pack far.obj --spheres 20 -o far.cbor").out;
  EXPECT_NE(table.find("1000000.25 0.25 0.25 m"), std::string::npos) << table;
}

// Scenes know no smallest radius, but `pack` does.
TEST_F(PackingCommands, AdviceNamesTheCommandThatHasTheOption) {
  writeFile(path("sheet.obj"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1e-6\nv 1 0 1e-6\nv 0 1 1e-6\nv 1 1 1e-6\n"
            "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 2 4 8 6\nf 4 3 7 8\nf 3 1 5 7\n");
  refuse("scene run pile --mesh sheet.obj", 3, {"`innersphere pack` a smaller --min-radius"});
  writeFile(path("open.obj"), kOpenTetrahedron);
  refuse("convert open.obj open.stl", 3, {"`innersphere pack` --repair"});
}

// What was said of the mesh is in the file, too.
TEST_F(PackingCommands, FilesKeepWhatWasMended) {
  std::istringstream lines(kTetrahedron);
  std::string line, inside_out;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string word, a, b, c;
    words >> word >> a >> b >> c;
    inside_out += word == "f" ? "f " + b + " " + a + " " + c + "\n" : line + "\n";
  }
  writeFile(path("tetra.obj"), inside_out);
  const Outcome outcome = run("pack tetra.obj --spheres 20 -o tetra.cbor --json");
  const auto warnings = nlohmann::json::parse(outcome.out)["warnings"];
  ASSERT_GE(warnings.size(), 1u) << outcome.out;
  EXPECT_NE(outcome.err.find(warnings[0].get<std::string>()), std::string::npos) << outcome.err;
  EXPECT_EQ(json("info tetra.cbor")["warnings"], warnings);
}

// The volume that a triangle mesh bounds, by the divergence theorem.
template <typename Corner>
double volumeOf(std::size_t triangles, const Corner& corner) {
  double six = 0;
  for (std::size_t i = 0; i < triangles; ++i) {
    const std::array<double, 3> a = corner(i, 0), b = corner(i, 1), c = corner(i, 2);
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

TEST_F(PackingCommands, SurfacesAreWrittenForOtherPrograms) {
  writeFile(path("tetra.obj"), kTetrahedron);
  succeed("convert box box.obj");
  succeed("pack tetra.obj --spheres 10 -o tetra.cbor");
  succeed("convert tetra.cbor again.obj");
  EXPECT_NEAR(json("pack again.obj --spheres 10 -o again.cbor")["volume"].get<double>(), 1.0 / 6, 1e-6);

  std::stringstream lines(readFile(path("box.obj")));
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::size_t, 3>> faces;
  for (std::string line; std::getline(lines, line);) {
    std::stringstream words(line.substr(2));
    if (line[0] == 'v') {
      std::array<double, 3> v{};
      words >> v[0] >> v[1] >> v[2];
      vertices.push_back(v);
    } else {
      std::array<std::size_t, 3> f{};
      words >> f[0] >> f[1] >> f[2];
      faces.push_back(f);
    }
  }
  EXPECT_NEAR(
      volumeOf(faces.size(),
               [&](std::size_t i, int k) { return vertices.at(faces[i][static_cast<std::size_t>(k)] - 1); }),
      1, 1e-6);

  succeed("convert box box.stl");
  const std::string stl = readFile(path("box.stl"));
  ASSERT_EQ(stl.size(), 84 + 50 * faces.size());
  EXPECT_NEAR(volumeOf(faces.size(),
                       [&](std::size_t i, int k) {
                         float p[3];
                         std::memcpy(p, stl.data() + 84 + 50 * i + 12 * static_cast<std::size_t>(k + 1),
                                     sizeof p);
                         return std::array<double, 3>{p[0], p[1], p[2]};
                       }),
              1, 1e-6);
  writeFile(path("spheres.xyzr"), "0 0 0 1\n");
  refuse("convert spheres.xyzr spheres.obj", 3, {"surface"});
  refuse("convert box box.cbor", 3, {"box", "pack"});
  refuse("convert tetra.obj tetra.ply", 3, {"tetra.obj is no packing", "surface", ".obj or .stl"});
  refuse("convert none.obj none.ply", 3, {"none.obj"});
}

// A part of 0.2 m, 1000 km from its origin, keeps its shape: %.9g would round its corners to 1 mm, single
// precision to 62 mm.
TEST_F(PackingCommands, SurfacesFarAwayKeepTheirShape) {
  writeFile(path("far.obj"),
            "v 1000000.1 0 0\nv 1000000.3 0 0\nv 1000000.1 0.2 0\nv 1000000.1 0 0.2\n"
            "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  succeed("pack far.obj --spheres 20 -o far.cbor");
  for (const std::string file : {"again.obj", "again.stl"}) {
    const Outcome outcome = run("convert far.cbor " + file);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("as text") != std::string::npos, file == "again.stl") << outcome.err;
    const Outcome packed = run("pack " + file + " --spheres 20 --json -o again.cbor --force");
    ASSERT_EQ(packed.exit_code, 0) << file << packed.err;
    EXPECT_NEAR(nlohmann::json::parse(packed.out)["volume"].get<double>() / (0.008 / 6), 1, 1e-6) << file;
  }
}

TEST_F(PackingCommands, TheSameBytesForAnyNumberOfThreads) {
  // More threads than cores make oneTBB warn on stderr.
  EXPECT_EQ(run("pack torus --spheres 200 --threads 1 -o one.json").exit_code, 0);
  EXPECT_EQ(run("pack torus --spheres 200 --threads 4 -o four.json").exit_code, 0);
  EXPECT_EQ(readFile(path("one.json")), readFile(path("four.json")));
}

// The C library takes its functions from versions for the processor; here it is told that it has less.
TEST_F(PackingCommands, TheSameBytesOnAnOlderProcessor) {
  const auto same = [&](const std::string& command, const std::string& kept) {
    const Outcome both =
        shell("run() { $TOOL -q " + command + " -o $1; }; run this-" + kept + " && export " +
              "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX2,-AVX,-FMA,-FMA4 && run older-" + kept +
              " && cmp this-" + kept + " older-" + kept + " && rm older-" + kept + " && mv -f this-" + kept +
              " " + kept);
    EXPECT_EQ(both.exit_code, 0) << command << "\n" << both.out << both.err;
  };
  // Shallow, and deep.
  writeFile(path("poses.csv"),
            "pose,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n"
            "1,0.6,-0.8,0,0.03,0.64,0.48,-0.6,0.05,0.48,0.36,0.8,0.06\n"
            "2,0.6,-0.8,0,0.5,0.64,0.48,-0.6,0.4,0.48,0.36,0.8,0.3\n");
  for (const std::string solid : {"nut", "cup --order coverage"}) {
    same("pack " + solid + " --spheres 200", "packing.json");
    for (const std::string estimator : {"surface", "volume-true"})
      same("overlap packing.json packing.json --poses poses.csv --estimator " + estimator, "table.csv");
    EXPECT_GT(std::stod(readCsv(readFile(path("table.csv")))[1][1]), 0);
  }
}

TEST_F(PackingCommands, CoversASolidAndSaysHowFarSpheresReachOut) {
  const auto summary = json("pack gear --cover --spheres 32 -o gear.json");
  EXPECT_EQ(summary["spheres"], 32);
  EXPECT_GT(summary["overhang_max"].get<double>(), summary["overhang_mean"].get<double>());
  const auto written = nlohmann::json::parse(readFile(path("gear.json")));
  EXPECT_EQ(written["format"], "innersphere-covering");
  EXPECT_EQ(written["spheres"].size(), 32u);
  const auto told = json("info gear.json");
  for (const char* key : {"spheres", "overhang_mean", "overhang_max", "inside", "union_volume"})
    EXPECT_EQ(told[key], summary[key]) << key;
  refuse("check gear.json", 3, {"cover", "overlap"});
  refuse("pack gear --cover -o gear.cbor", 2, {".cbor", ".xyzr"});
}

TEST_F(PackingCommands, MakesAClumpAndSaysHowNearItComes) {
  writeFile(path("tetra.obj"), kTetrahedron);
  const auto summary = json("pack tetra.obj --clump --spheres 12");
  EXPECT_EQ(summary["spheres"], 12);
  EXPECT_GT(summary["inside"].get<double>(), 0.8);
  EXPECT_LT(summary["outside"].get<double>(), 0.2);
  const auto written = nlohmann::json::parse(readFile(path("tetra.json")));
  EXPECT_EQ(written["format"], "innersphere-clump");
  EXPECT_EQ(written["spheres"].size(), 12u);
  EXPECT_EQ(written["inside"], summary["inside"]);
  EXPECT_EQ(written["union"]["volume"], summary["union_volume"]);
  EXPECT_EQ(json("info tetra.json")["gap_max"], summary["gap_max"]);
  refuse("check tetra.json", 3, {"clump", "overlap"});
  EXPECT_LT(
      json("pack tetra.obj --clump --spheres 12 --outside-weight 10 -o in.xyzr")["outside"].get<double>(),
      summary["outside"].get<double>() / 2);
  EXPECT_EQ(json("pack box --clump -o box.ply")["spheres"], 64);

  refuse("pack gear --clump --spheres 0", 2, {"1 to 1000 spheres"});
  refuse("pack gear --clump --cover", 2, {"--cover", "--clump"});
  refuse("pack gear --clump --density 0.5", 2, {"--density"});
  refuse("pack gear --clump -o gear.cbor", 2, {"clump", ".cbor", ".xyzr"});
  refuse("pack gear --outside-weight 2", 2, {"--clump"});
  writeFile(path("open.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n");
  refuse("pack open.obj --clump", 3, {"open edges"});
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

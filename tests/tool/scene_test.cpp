// Scenes, as the tool runs and records them.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "meshes.hpp"
#include "tool_runner.hpp"

namespace innersphere::test {
namespace {

// A recording by column.
std::map<std::string, std::vector<double>> columns(const std::string& csv) {
  const auto rows = readCsv(csv);
  std::map<std::string, std::vector<double>> result;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].size(), rows[0].size());
    for (std::size_t k = 0; k < rows[0].size(); ++k) result[rows[0][k]].push_back(std::stod(rows[i][k]));
  }
  return result;
}

class SceneRun : public ToolTest {};

TEST_F(SceneRun, StackIsRecorded) {
  const auto summary = json("scene run stack --spheres 100 --seconds 0.25 --dt 0.0125 --csv stack.csv");
  EXPECT_EQ(summary["scene"], "stack");
  EXPECT_EQ(summary["bodies"], 10);
  EXPECT_EQ(summary["steps"], 20);
  EXPECT_NEAR(summary["seconds"].get<double>(), 0.25, 1e-9);
  EXPECT_EQ(summary["solids"][0]["spheres"], 100);
  EXPECT_LE(summary["step_ms"]["median"], summary["step_ms"]["p99"]);
  EXPECT_LE(summary["step_ms"]["p99"], summary["step_ms"]["worst"]);

  auto recording = columns(readFile(path("stack.csv")));
  ASSERT_EQ(recording["time_s"].size(), 21u) << "the start and 20 steps";
  for (std::size_t i = 0; i < 21; ++i)
    EXPECT_NEAR(recording["time_s"][i], 0.0125 * static_cast<double>(i), 1e-9);
  // Ten boxes of 125 kg at heights 0.25, 0.75, ... 4.75 m.
  EXPECT_NEAR(recording["potential_J"][0], 125 * 9.81 * 25, 2);
  EXPECT_EQ(recording["kinetic_J"][0], 0);
  EXPECT_EQ(recording.count("body9_qw"), 1u);
  EXPECT_EQ(recording.count("body10_qw"), 0u);
  for (std::size_t i = 0; i < 21; ++i) {
    for (int body = 0; body < 10; ++body) {
      double square = 0;
      for (const char* part : {"_qx", "_qy", "_qz", "_qw"}) {
        square += std::pow(recording["body" + std::to_string(body) + part][i], 2);
      }
      EXPECT_NEAR(square, 1, 1e-5);
      EXPECT_NEAR(recording["body" + std::to_string(body) + "_z"][i], 0.25 + 0.5 * body, 0.05)
          << "the stack stands";
    }
    EXPECT_TRUE(std::isfinite(recording["angular_momentum_x"][i]));
    EXPECT_NEAR(recording["energy_J"][i], recording["kinetic_J"][i] + recording["potential_J"][i], 1e-4);
    EXPECT_GE(recording["deepest_overlap_m"][i], 0);
  }
}

TEST_F(SceneRun, ChainFallsBetweenFreelyAndTaut) {
  // In the first step a link that nothing pulls gains the speed g dt, one on a taut string at the angle a to
  // the vertical g sin a dt across it, so g sin^2 a dt down: all of them alike, for the string does not bend
  // yet. The links start touching.
  json("scene run chain-swing --spheres 100 --seconds 0.01 --dt 0.0025 --csv chain.csv");
  auto recording = columns(readFile(path("chain.csv")));
  constexpr double kAngle = 0.9;
  const double free =
      -9 * 1000 * 2 * M_PI * M_PI * 1 * 0.25 * 0.25 * 9.81 * 0.0025;  // links times 2 pi^2 R r^2
  EXPECT_GT(recording["momentum_z"][1], 1.01 * free);
  EXPECT_LT(recording["momentum_z"][1], 0.99 * free * std::pow(std::sin(kAngle), 2));
  EXPECT_EQ(recording["body0_z"].front(), recording["body0_z"].back()) << "the first link is held";
}

TEST_F(SceneRun, PileRepeatsToTheLastBit) {
  const std::string options =
      " --spheres 40 --seconds 0.4 --dt 0.0166667 --mesh box --mesh torus --quiet --csv ";
  succeed("scene run pile --seed 3" + options + "one.csv");
  succeed("scene run pile --seed 3" + options + "two.csv");
  succeed("scene run pile --seed 4" + options + "other.csv");
  auto one = columns(readFile(path("one.csv")));
  auto two = columns(readFile(path("two.csv")));
  auto other = columns(readFile(path("other.csv")));
  one.erase("step_ms");
  two.erase("step_ms");
  EXPECT_EQ(one, two);
  EXPECT_NE(one["body5_qx"], other["body5_qx"]);
  EXPECT_GT(one["contacts"].back(), 0) << "the first layer has landed";
}

TEST_F(SceneRun, PileOfAUsersMeshWithPictureAndReplay) {
  writeFile(path("tetra.obj"), kTetrahedron);
  const auto summary = json(
      "scene run pile --mesh tetra.obj --spheres 30 --seconds 0.1 --dt 0.02 "
      "--png pile.png --html pile.html --width 64 --height 48 --samples 2");
  EXPECT_EQ(summary["solids"].size(), 1u);
  EXPECT_EQ(summary["bodies"], 24);
  EXPECT_NEAR(summary["solids"][0]["size"].get<double>(), 0.7, 1e-6) << "scaled to the scene";
  EXPECT_EQ(readFile(path("pile.png")).substr(1, 3), "PNG");
  EXPECT_NE(readFile(path("pile.html")).find("24 moving bodies"), std::string::npos);
  EXPECT_EQ(files(), (std::set<std::string>{"tetra.obj", "pile.png", "pile.html"}));
}

TEST_F(SceneRun, SummaryForPeople) {
  const std::string out = succeed("scene run stack --spheres 50 --seconds 0.05").out;
  for (const char* word : {"density", "median", "worst", "backend", "deepest overlap", "at rest", "energy"}) {
    EXPECT_NE(out.find(word), std::string::npos) << word;
  }
}

TEST_F(SceneRun, TruthIsComparedWithWhatWasMeasured) {
  // A ball under its own weight: the truth is shown after a second, not before.
  const auto shown = json("scene check slide --spheres 100");
  EXPECT_EQ(shown[0]["scene"], "slide");
  EXPECT_EQ(shown[0]["truths"].size(), 8u);
  for (const auto& truth : shown[0]["truths"]) {
    const double off = truth["measured"].get<double>() - truth["expected"].get<double>();
    EXPECT_EQ(truth["holds"].get<bool>(), std::fabs(off) <= truth["tolerance"].get<double>());
    EXPECT_FALSE(truth["source"].get<std::string>().empty());
  }
  const auto early = json("scene run slide --spheres 100 --seconds 0.1 --check");
  EXPECT_TRUE(early["truths"][0]["measured"].is_null());
}

TEST_F(SceneRun, AMissedTruthIsAnAnswer) {
  // With one step a second nothing holds.
  EXPECT_EQ(run("scene check slide --spheres 100 --dt 1 --quiet").exit_code, 1);
  EXPECT_EQ(run("scene run slide --spheres 100 --dt 1 --quiet").exit_code, 0);
  EXPECT_EQ(run("scene run slide --spheres 100 --dt 1 --quiet --check").exit_code, 1);
}

TEST_F(SceneRun, GalleryHoldsFilmsWithTheirContacts) {
  succeed("scene gallery slide collisions --spheres 50 --seconds 0.1 --quiet -o gallery.html");
  const std::string page = readFile(path("gallery.html"));
  const std::string start = "type=\"application/json\">";
  const std::size_t begin = page.find(start) + start.size();
  const auto films = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  ASSERT_EQ(films.size(), 2u);
  EXPECT_EQ(films[0]["title"], "Boxes on inclines");
  EXPECT_EQ(films[1]["title"], "Colliding balls");
  ASSERT_EQ(films[0]["notes"].size(), 8u) << "a line for each truth";
  for (const auto& note : films[0]["notes"]) {
    EXPECT_TRUE(note["holds"].is_null()) << "a tenth of a second does not show where a box is after one";
    EXPECT_NE(note["text"].get<std::string>().find("not shown, it takes 1 s"), std::string::npos) << note;
  }
  // Seven frames in a tenth of a second, and where each one's contacts begin: eight numbers of four bytes, in
  // base 64.
  EXPECT_EQ(films[0]["first_contacts"].get<std::string>().size(), 44u);
  EXPECT_GT(films[0]["contacts"].get<std::string>().size(), 0u);
  EXPECT_EQ(films[1]["contacts"].get<std::string>().size(), 0u) << "the balls have not met yet";
  EXPECT_EQ(files(), std::set<std::string>{"gallery.html"});
  refuse("scene gallery slide -o gallery.html", 5, {"gallery.html", "--force"});
  refuse("scene gallery nothing -o new.html", 2, {"nothing"});
  refuse("scene gallery", 2, {"--output"});
}

TEST_F(SceneRun, PageSaysInPlainWordsWhatCameOut) {
  // The notes of a scene's page by what they are about, with whether they hold.
  const auto notes = [this](const std::string& arguments) {
    succeed("scene run " + arguments + " --quiet --force --html page.html");
    const std::string page = readFile(path("page.html"));
    const std::string start = "type=\"application/json\">";
    const std::size_t begin = page.find(start) + start.size();
    const auto films = nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
    std::map<std::string, nlohmann::json> result;
    for (const auto& note : films[0]["notes"]) {
      const std::string text = note["text"];
      result[text.substr(0, text.find(':'))] = note;
    }
    return result;
  };
  auto pile = notes("pile --spheres 60 --seconds 0.1 --dt 0.02 --mesh box");
  const auto& fell = pile["Bodies that fell through the floor"];
  EXPECT_EQ(fell["holds"], true);
  EXPECT_EQ(fell["text"], "Bodies that fell through the floor: 0 (as it should be)");

  // With a step of a second nothing holds.
  auto slide = notes("slide --spheres 100 --dt 1");
  ASSERT_EQ(slide.size(), 8u);
  for (const auto& [what, note] : slide) {
    const std::string text = note["text"];
    EXPECT_TRUE(std::isupper(static_cast<unsigned char>(what[0]))) << text;
    EXPECT_NE(text.find("(should be "), std::string::npos) << text;
    EXPECT_EQ(text.find("+-"), std::string::npos) << text;
    EXPECT_NE(text.find(", give or take "), std::string::npos) << text;
  }
  EXPECT_TRUE(std::any_of(slide.begin(), slide.end(),
                          [](const auto& item) { return item.second["holds"] == false; }));
}

TEST_F(SceneRun, BadInputIsNamed) {
  refuse("scene run nothing", 2, {"nothing", "pile", "nut"});
  refuse("scene check pile nothing", 2, {"nothing", "pile"});
  refuse("scene run nut --mesh box", 2, {"nut", "pile"});
  refuse("scene run pile --dt 0", 2, {"--dt"});
  refuse("scene run pile --stiffness -1", 2, {"--stiffness", "-1"});
  for (const std::string command :
       {"scene run drop", "scene check drop", "scene gallery drop -o drop.html"}) {
    refuse(command + " --seconds 1e-9", 2, {"1e-09 s", "single step"});
    refuse(command + " --seconds 1e9", 2, {"1e+09 s", "ten million"});
    refuse(command + " --seconds 1e308 --dt 1e-6", 2, {"1e+308 s", "ten million"});
  }
  refuse("scene run pile --seconds -1", 2, {"--seconds", "-1"});
}

}  // namespace
}  // namespace innersphere::test

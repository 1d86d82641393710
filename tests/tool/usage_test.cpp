// Help, version and wrong command lines.
#include <algorithm>
#include <sstream>

#include "innersphere/packer.hpp"
#include "tool_runner.hpp"

namespace innersphere::test {
namespace {

class Usage : public ToolTest {};

TEST_F(Usage, EveryCommandHasHelp) {
  for (const char* command :
       {"", "pack", "info", "check", "convert", "view", "overlap", "merge", "scene", "scene list",
        "scene run", "scene check", "scene gallery", "solids", "help", "completion", "man"}) {
    const Outcome outcome = succeed(std::string(command) + " --help");
    EXPECT_NE(outcome.out.find("Usage:"), std::string::npos) << command;
    // Lines are no longer than this, but for examples, which are to be copied.
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("  innersphere ", 0) != 0) EXPECT_LE(line.size(), 100u) << line;
    }
  }
}

TEST_F(Usage, HelpExplainsTheExitStatus) {
  EXPECT_NE(succeed("--help").out.find("Exit status"), std::string::npos);
}

TEST_F(Usage, HelpShowsTheDefaultsOfTheLibrary) {
  const std::string help = succeed("pack --help").out;
  const std::size_t begin = help.find("--delta");
  ASSERT_NE(begin, std::string::npos) << help;
  const std::string line = help.substr(begin, help.find('\n', begin) - begin);
  EXPECT_NE(line.find(nlohmann::json(PackOptions().delta).dump()), std::string::npos) << line;
}

TEST_F(Usage, Version) {
  EXPECT_EQ(succeed("--version").out, "innersphere " INNERSPHERE_VERSION "\n");
}

TEST_F(Usage, WrongCommandLinesAreNamed) {
  refuse("", 2, {"Usage:", "pack", "Examples:"});
  refuse("scene", 2, {"Usage:", "gallery"});
  refuse("frobnicate", 2, {"frobnicate"});
  refuse("scene frobnicate", 2, {"frobnicate", "innersphere scene --help"});
  refuse("pack", 2, {"SOLID", "innersphere pack --help"});
  refuse("pack box torus", 2, {"torus"});
  refuse("overlap a b", 2, {"--poses"});
  for (const char* shard : {"0/3", "4/3", "3", "1/", "-1/3", "1/3x"})
    refuse(std::string("overlap a b --poses p.csv -o out.csv --shard ") + shard, 2,
           {"--shard", shard, "3/8"});
  refuse("merge -o out.csv", 2, {"SHARD"});
  refuse("help nonsense", 2, {"nonsense"});
  refuse("pack box --spheres", 2, {"--spheres"});
  refuse("pack box --spheres -3 -o box.json", 2, {"--spheres"});
  refuse("pack box --spheres ten -o box.json", 2, {"--spheres"});
  refuse("pack box --density 2 -o box.json", 2, {"--density"});
  refuse("pack box --scale 0 -o box.json", 2, {"--scale"});
  refuse("pack box -o box.doc", 2, {"box.doc", ".cbor"});
  refuse("scene run nowhere", 2, {"nowhere", "pile"});
  refuse("scene run stack --backend tpu", 2, {"--backend", "cuda"});
  refuse("scene run stack --dt 0", 2, {"--dt"});
  refuse("scene run stack --seed -1", 2, {"--seed"});
  refuse("view box --spheres -1", 2, {"--spheres"});
}

TEST_F(Usage, MessagesAreThoseOfTheTool) {
  for (const char* arguments : {"frobnicate", "pack", "pack box --spheres", "pack box --jsno",
                                "scene run nowhere", "info missing.cbor", "pack box --spheres ten"}) {
    EXPECT_EQ(run(arguments).err.find("innersphere: "), 0u) << run(arguments).err;
  }
}

TEST_F(Usage, WhatWasMeantIsSuggested) {
  refuse("pakc box", 2, {"command \"pakc\"", "did you mean pack?"});
  refuse("scene urn pile", 2, {"did you mean run?"});
  refuse("scene run piel", 2, {"did you mean pile?"});
  refuse("pack toruss", 3, {"did you mean torus?"});
  refuse("pack box --sphere 10 -o box.json", 2, {"option --sphere;", "did you mean --spheres?"});
  refuse("pack --sphere=10", 2, {"option --sphere;", "did you mean --spheres?"});
  refuse("info box.json --jsno", 2, {"option --jsno", "did you mean --json?"});
  refuse("view box --show sphere", 2, {"surface, spheres, split"});
  refuse("help pakc", 2, {"did you mean pack?"});
  EXPECT_EQ(run("pack box --colour red").err.find("did you mean"), std::string::npos);
}

TEST_F(Usage, TheLastOfRepeatedOptionsCounts) {
  EXPECT_EQ(json("pack box -o box.json --spheres 5 --spheres 10 --quiet")["spheres"], 10);
}

TEST_F(Usage, CountsMayBeAbbreviated) {
  for (const char* ten : {"10", "1e1", "0.01k", "1.0e+1"}) {
    EXPECT_EQ(json("pack box -o box.json --force --spheres " + std::string(ten))["spheres"], 10) << ten;
  }
  EXPECT_EQ(run("scene run slide --spheres 5 --seconds 0.01 --seed 18446744073709551615").exit_code, 0);
  for (const char* wrong : {"1.5", "1e-1", "k", "10K9", "1e400", "0x10", "-1", "nan", "1e300"}) {
    refuse("pack box --spheres " + std::string(wrong), 2, {"--spheres", wrong, "10k"});
  }
  refuse("view box --width 15", 2, {"--width", "from 16 to 16384"});
  refuse("pack box --threads 1e10", 2, {"--threads"});
}

TEST_F(Usage, HelpIsACommandToo) {
  EXPECT_EQ(succeed("help").out, succeed("--help").out);
  EXPECT_EQ(succeed("help scene run").out, succeed("scene run --help").out);
  const std::string all = succeed("--help-all").out;
  for (const char* command : {"pack", "scene run", "scene gallery", "help"}) {
    EXPECT_NE(all.find(succeed(std::string(command) + " --help").out), std::string::npos) << command;
  }
}

TEST_F(Usage, ExamplesAreThoseOfTheCommand) {
  for (const std::string command : {"pack", "info", "check", "convert", "view", "overlap", "scene list",
                                    "scene run", "scene check", "scene gallery", "solids"}) {
    const std::string help = succeed(command + " --help").out;
    const std::size_t examples = help.find("Example");
    ASSERT_NE(examples, std::string::npos) << command;
    EXPECT_NE(help.find("\n  innersphere " + command, examples), std::string::npos) << help;
  }
}

// What bash offers for the last of some words.
std::set<std::string> offered(const Outcome& outcome) {
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  std::set<std::string> lines;
  std::stringstream stream(outcome.out);
  for (std::string line; std::getline(stream, line);) lines.insert(line);
  return lines;
}

TEST_F(Usage, BashCompletesCommandsOptionsAndNames) {
  writeFile(path("complete.bash"), succeed("completion bash").out +
                                       "COMP_WORDS=(\"$@\")\nCOMP_CWORD=$(($# - 1))\n_innersphere\n"
                                       "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
  EXPECT_EQ(shell("bash -n complete.bash").exit_code, 0);
  writeFile(path("torso.obj"), "");
  const auto complete = [this](const std::string& words) {
    return offered(shell("bash complete.bash innersphere " + words));
  };
  using Names = std::set<std::string>;
  EXPECT_EQ(complete("pa"), Names{"pack"});
  EXPECT_EQ(complete("scene g"), Names{"gallery"});
  EXPECT_EQ(complete("scene run pi"), Names{"pile"});
  EXPECT_EQ(complete("scene check pile slid"), Names{"slide"});
  EXPECT_EQ(complete("pack to"), (Names{"torus", "torso.obj"}));
  EXPECT_EQ(complete("pack torus --sph"), Names{"--spheres"});
  EXPECT_EQ(complete("-q scene run --resp"), Names{"--response"});
  EXPECT_EQ(complete("scene run pile --response pen"), Names{"penalty"});
  EXPECT_EQ(complete("pack torus -o tor"), Names{"torso.obj"});
  EXPECT_EQ(complete("pack torus --spheres ''"), Names{""});
  EXPECT_EQ(complete("completion z"), Names{"zsh"});
  EXPECT_EQ(complete("scene check --che"), Names{""}) << "an option of another command";
}

TEST_F(Usage, OtherShellsAreCompletedToo) {
  for (const char* shell_name : {"zsh", "fish"}) {
    const std::string script = succeed("completion " + std::string(shell_name)).out;
    for (const char* word : {"gallery", "spheres", "pile", "torus", "volume-true"}) {
      EXPECT_NE(script.find(word), std::string::npos) << shell_name << ": " << word;
    }
    writeFile(path("script"), script);
    const Outcome parsed =
        shell("! command -v " + std::string(shell_name) + " || " + shell_name + " -n script");
    EXPECT_EQ(parsed.exit_code, 0) << parsed.err;
  }
  refuse("completion ksh", 2, {"ksh", "bash, zsh, fish"});
}

TEST_F(Usage, TheManualPageHasEveryOption) {
  const std::string page = succeed("man").out;
  for (const char* part :
       {".TH INNERSPHERE 1", ".SH NAME", ".SH SYNOPSIS", ".SH EXIT STATUS", ".SH EXAMPLES"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  // Options as help shows them: "  -o,--output TEXT ..." or "  --json ...".
  std::stringstream help(succeed("--help-all").out);
  std::size_t options = 0;
  for (std::string line; std::getline(help, line);) {
    const std::size_t at = line.find("--");
    if (line.rfind("  -", 0) != 0 || at == std::string::npos) continue;
    std::string name;
    for (const char c : line.substr(at, line.find_first_of(" =", at) - at)) {
      name += c == '-' ? "\\-" : std::string(1, c);
    }
    EXPECT_NE(page.find("\\fB" + name + "\\fR"), std::string::npos) << line;
    ++options;
  }
  EXPECT_GT(options, 50u);
}

TEST_F(Usage, ListsForPrograms) {
  const auto solids = json("solids");
  const auto box =
      std::find_if(solids.begin(), solids.end(), [](const auto& row) { return row["name"] == "box"; });
  ASSERT_NE(box, solids.end());
  EXPECT_NEAR((*box)["volume"].template get<double>(), 1, 1e-12);
  EXPECT_EQ((*box)["size"], (std::vector<double>{1, 1, 1}));
  const auto scenes = json("scene list");
  std::size_t lines = 0;
  for (const char c : succeed("scene list").out) lines += c == '\n';
  EXPECT_EQ(scenes.size(), lines);
  EXPECT_EQ(scenes[0]["name"].get<std::string>().empty(), false);
}

TEST_F(Usage, SolidsAndScenesAreListed) {
  EXPECT_NE(succeed("solids").out.find("torus"), std::string::npos);
  EXPECT_NE(succeed("scene list").out.find("pile"), std::string::npos);
}

}  // namespace
}  // namespace innersphere::test

// Help, version and wrong command lines.
#include "innersphere/packer.hpp"
#include "tool_runner.hpp"

namespace innersphere::test {
namespace {

class Usage : public ToolTest {};

TEST_F(Usage, EveryCommandHasHelp) {
  for (const char* command : {"", "pack", "info", "check", "convert", "view", "overlap", "scene",
                              "scene list", "scene run", "scene check", "scene gallery", "solids"}) {
    const Outcome outcome = succeed(std::string(command) + " --help");
    EXPECT_NE(outcome.out.find("Usage:"), std::string::npos) << command;
  }
}

TEST_F(Usage, HelpExplainsTheExitStatus) {
  EXPECT_NE(succeed("--help").out.find("Exit status"), std::string::npos);
}

TEST_F(Usage, HelpShowsTheDefaultsOfTheLibrary) {
  const std::string help = succeed("pack --help").out;
  const std::size_t begin = help.find("--spheres");
  ASSERT_NE(begin, std::string::npos) << help;
  const std::string line = help.substr(begin, help.find('\n', begin) - begin);
  EXPECT_NE(line.find(std::to_string(PackOptions().spheres)), std::string::npos) << line;
}

TEST_F(Usage, Version) {
  EXPECT_EQ(succeed("--version").out, "innersphere " INNERSPHERE_VERSION "\n");
}

TEST_F(Usage, WrongCommandLinesAreNamed) {
  refuse("", 2, {"subcommand"});
  refuse("frobnicate", 2, {"frobnicate"});
  refuse("pack box --sphere 10 -o box.json", 2, {"--sphere"});
  refuse("pack box", 2, {"--output"});
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

TEST_F(Usage, SolidsAndScenesAreListed) {
  EXPECT_NE(succeed("solids").out.find("torus"), std::string::npos);
  EXPECT_NE(succeed("scene list").out.find("pile"), std::string::npos);
}

}  // namespace
}  // namespace innersphere::test

#include "scene_run.hpp"

#include <memory>

#include "contact_arguments.hpp"
#include "exit_codes.hpp"
#include "inputs.hpp"
#include "numbers.hpp"
#include "outputs.hpp"
#include "pictures.hpp"
#include "scene_report.hpp"
#include "scenes/scene.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  std::string scene;
  demo::SceneOptions options;
  std::vector<std::string> meshes;
  MeshOptions mesh;
  std::string csv;
  PictureArguments pictures;
  bool json = false;
  bool check = false;
  bool force = false;
};

int run(Arguments& arguments) {
  const demo::Scene& scene = demo::sceneNamed(arguments.scene);
  checkOutput(arguments.csv, arguments.force);
  checkPictures(arguments.pictures, arguments.force);

  // All of them are read before the first one is packed: a bad file shows at once.
  for (const std::string& path : arguments.meshes) {
    arguments.options.solids.push_back(loadSolid({path, arguments.mesh}));
  }
  arguments.options.progress = progressBar();
  demo::ScenePlay play = demo::play(scene, arguments.options);
  clearProgressBar();
  addTexts(scene, play);

  describe(scene, play).print(arguments.json);
  std::fflush(stdout);
  if (!arguments.csv.empty()) {
    writeTextOutput(arguments.csv, arguments.force, demo::toCsv(play.recording));
    say("wrote " + arguments.csv);
  }
  writePictures(play.recording.film, arguments.pictures, arguments.force);
  return arguments.check && !allHold(play.verdicts) ? kCheckFailed : kOk;
}

}  // namespace

void addSceneOptions(CLI::App& command, demo::SceneOptions& options) {
  const auto otherwise = [](CLI::Option* option) { option->default_str("the scene's own"); };
  otherwise(command.add_option("--seconds", options.seconds, "Simulated time [s]")->check(positive()));
  otherwise(command.add_option("--dt", options.dt, "Time step [s]")->check(CLI::Range(1e-6, 1.0)));
  otherwise(command.add_option("--spheres", options.spheres, "Of each solid's packing")->check(positive()));
  addResponseOption(command, options.contact.response);
  command.add_option("--stiffness", options.contact.stiffness, "Pressure for a metre of overlap [N/m^3]")
      ->check(notNegative())
      ->default_str("the scene's own");
  command.add_option("--damping", options.contact.damping, "Of contacts, as a fraction of critical damping")
      ->check(notNegative())
      ->capture_default_str();
  addBackendOption(command, options.contact.backend);
  addEstimatorOption(command, options.contact.estimator);
  addChoice<demo::BodyShape>(command, "--shape", options.bodies.shape,
                             {{"packing", demo::BodyShape::packing},
                              {"gimpact", demo::BodyShape::gimpact},
                              {"spheres", demo::BodyShape::spheres},
                              {"convex", demo::BodyShape::convex}},
                             "What collides, to compare: packings, or Bullet's triangle meshes, compounds of "
                             "the packings' spheres, or compounds of convex parts");
  command
      .add_option("--concavity", options.bodies.concavity,
                  "How far convex parts may leave their solid, relative to its size")
      ->check(positive())
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Of random places and orientations")
      ->check(notNegative())
      ->capture_default_str();
}

Progress progressOfScene(const std::string& name) {
  return [bar = progressBar(), name](const char* stage, double fraction) {
    return bar((name + ": " + stage).c_str(), fraction);
  };
}

void addSceneRunCommand(CLI::App& scene, Session& session) {
  CLI::App* command = scene.add_subcommand("run", "Step a scene without a window and say what happened");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("NAME", arguments->scene, "One of `innersphere scene list`")->required();
  addSceneOptions(*command, arguments->options);
  command
      ->add_option("--mesh", arguments->meshes,
                   "Mesh file to use instead of the scene's own solids; may be repeated")
      ->take_all()
      ->expected(1);
  addRepairOption(*command, arguments->mesh);
  command->add_option("--csv", arguments->csv,
                      "Write each step: energies, momenta, contacts, and each body's pose");
  addPictureOptions(*command, arguments->pictures);
  command->add_flag("--json", arguments->json, "Print the summary as JSON");
  command->add_flag("--check", arguments->check, "Exit status 1 if the scene misses its truth");
  command->add_flag("--force", arguments->force, "Replace existing outputs");
  command->footer(
      "Examples:\n"
      "  innersphere scene run pile --png pile.png --html pile.html\n"
      "  innersphere scene run pile --mesh bunny.obj --mesh cow.obj --spheres 2000\n"
      "  innersphere scene run chain-hang --dt 0.0166667 --csv chain.csv --json");
  command->callback([arguments, &session] { session.exit_code = run(*arguments); });
}

}  // namespace innersphere::tool

#include <memory>

#include "contact_arguments.hpp"
#include "exit_codes.hpp"
#include "innersphere/solids.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "pictures.hpp"
#include "scene_commands.hpp"
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

  const PictureArguments& pictures = arguments.pictures;
  const bool taken = isStdout(arguments.csv) || isStdout(pictures.png) || isStdout(pictures.html);
  if (!taken || !isQuiet()) describe(scene, play).print(arguments.json, taken ? stderr : stdout);
  std::fflush(stdout);
  if (!arguments.csv.empty()) {
    writeTextOutput(arguments.csv, arguments.force, demo::toCsv(play.recording));
    say("wrote " + arguments.csv);
  }
  writePictures(play.recording.film, arguments.pictures, arguments.force);
  return arguments.check && !allHold(play.verdicts) ? kCheckFailed : kOk;
}

}  // namespace

std::vector<std::string> namesOfScenes() {
  std::vector<std::string> names;
  for (const demo::Scene& scene : demo::scenes()) names.push_back(scene.name);
  return names;
}

void addSceneOptions(Command& command, demo::SceneOptions& options) {
  const std::string own = "the scene's own";
  command.number("--seconds", options.seconds, kPositive, "Simulated time [s]").withDefault(own);
  command.number("--dt", options.dt, {1e-6, 1}, "Time step [s]").withDefault(own);
  command.count("--spheres", options.spheres, {1}, "Of each solid's packing").withDefault(own);
  addResponseOption(command, options.contact.response);
  command
      .number("--stiffness", options.contact.stiffness, kNotNegative,
              "Pressure for a metre of overlap [N/m^3]")
      .withDefault(own);
  command.number("--damping", options.contact.damping, kNotNegative,
                 "Of contacts, as a fraction of critical damping");
  addBackendOption(command, options.contact.backend);
  addEstimatorOption(command, options.contact.estimator);
  command.choice<demo::BodyShape>(
      "--shape", options.bodies.shape,
      {{"packing", demo::BodyShape::packing},
       {"gimpact", demo::BodyShape::gimpact},
       {"spheres", demo::BodyShape::spheres},
       {"convex", demo::BodyShape::convex}},
      "What collides, to compare: packings, or Bullet's triangle meshes, compounds of "
      "the packings' spheres, or compounds of convex parts");
  command.choice<SphereOrder>("--order", options.bodies.order,
                              {{"radius", SphereOrder::radius}, {"coverage", SphereOrder::coverage}},
                              "What the spheres of the packings are chosen for, as in `innersphere pack`");
  command.number("--concavity", options.bodies.concavity, kPositive,
                 "How far convex parts may leave their solid, relative to its size");
  command.flag("--plain", options.plain,
               "Bullet as its HelloWorld has it: solver mode untouched, stepSimulation(1/60, 10), bodies may "
               "sleep");
  command.choice<demo::SolverKind>(
      "--solver", options.solver.kind,
      {{"bullet", demo::SolverKind::bullet}, {"substep", demo::SolverKind::substep}},
      "What solves contacts and constraints: Bullet's sequential impulses, or SubstepSolver");
  command.count("--substeps", options.solver.substeps, {0, 1000},
                "Of SubstepSolver in a step; 0: it chooses");
  command.count("--iterations", options.solver.iterations, {0, 10000},
                "Of Bullet's solver in a step; 0: its 10");
  command.count("--seed", options.seed, kNotNegative, "Of random places and orientations");
}

Progress progressOfScene(const std::string& name) {
  return [bar = progressBar(), name](const char* stage, double fraction) {
    return bar((name + ": " + stage).c_str(), fraction);
  };
}

Command sceneRunCommand() {
  Command command("run", "Step a scene without a window and say what happened");
  auto arguments = std::make_shared<Arguments>();
  command.argument("NAME", arguments->scene, "One of `innersphere scene list`").oneOf(namesOfScenes());
  addSceneOptions(command, arguments->options);
  command
      .texts("--mesh", arguments->meshes,
             "Mesh file to use instead of the scene's own solids, in the scenes " +
                 demo::namesOfScenesThatTakeSolids() + "; may be repeated")
      .withFile()
      .withSuggestions(namedSolids());
  addRepairOption(command, arguments->mesh);
  command.text("--csv", arguments->csv, "Write each step: energies, momenta, contacts, and each body's pose")
      .withFile();
  addPictureOptions(command, arguments->pictures);
  command.flag("--json", arguments->json, "Print the summary as JSON");
  command.flag("--check", arguments->check, "Exit status 1 if the scene misses its truth");
  command.flag("--force", arguments->force, "Replace existing outputs");
  command.examples = {"innersphere scene run pile --png pile.png --html pile.html",
                      "innersphere scene run pile --mesh bunny.obj --mesh cow.obj --spheres 2000",
                      "innersphere scene run chain-hang --dt 0.0166667 --csv chain.csv --json"};
  command.run = [arguments] { return run(*arguments); };
  return command;
}

}  // namespace innersphere::tool

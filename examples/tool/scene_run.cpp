#include "scene_run.hpp"

#include <memory>

#include "contact_arguments.hpp"
#include "innersphere/error.hpp"
#include "inputs.hpp"
#include "numbers.hpp"
#include "outputs.hpp"
#include "pictures.hpp"
#include "scene_report.hpp"
#include "scenes/recording.hpp"
#include "scenes/scene.hpp"
#include "scenes/world.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  std::string scene;
  demo::SceneOptions options;
  std::vector<std::string> meshes;
  MeshOptions mesh;
  double seconds = 5;
  double dt = 1.0 / 240;
  std::string csv;
  PictureArguments pictures;
  bool json = false;
  bool force = false;
};

void run(Arguments& arguments) {
  const demo::Scene& scene = demo::sceneNamed(arguments.scene);
  checkOutput(arguments.csv, arguments.force);
  checkPictures(arguments.pictures, arguments.force);

  // All of them are read before the first one is packed: a bad file shows at once.
  for (const std::string& path : arguments.meshes) {
    arguments.options.solids.push_back(loadSolid({path, arguments.mesh}));
  }
  const Progress progress = progressBar();
  arguments.options.progress = progress;
  demo::SceneWorld world(arguments.options.contact);
  world.film.title = scene.name;
  scene.build(world, arguments.options);
  world.film.caption = captionOf(world, arguments.dt);
  const demo::Recording recording = demo::record(world, arguments.seconds, arguments.dt, progress);
  clearProgressBar();

  describe(scene.name, world, recording, arguments.options.contact).print(arguments.json);
  std::fflush(stdout);
  if (!arguments.csv.empty()) {
    writeTextOutput(arguments.csv, arguments.force, demo::toCsv(recording));
    say("wrote " + arguments.csv);
  }
  writePictures(recording.film, arguments.pictures, arguments.force);
}

}  // namespace

void addSceneRunCommand(CLI::App& scene) {
  CLI::App* command = scene.add_subcommand("run", "Step a scene without a window and say what happened");
  auto arguments = std::make_shared<Arguments>();
  demo::SceneOptions& options = arguments->options;
  command->add_option("NAME", arguments->scene, "One of `innersphere scene list`")->required();
  command->add_option("--seconds", arguments->seconds, "Simulated time [s]")
      ->check(positive())
      ->capture_default_str();
  command->add_option("--dt", arguments->dt, "Time step [s]")
      ->check(CLI::Range(1e-6, 1.0))
      ->capture_default_str();
  command->add_option("--spheres", options.spheres, "Of each solid's packing")
      ->check(positive())
      ->capture_default_str();
  addResponseOption(*command, options.contact.response);
  addBackendOption(*command, options.contact.backend);
  addEstimatorOption(*command, options.contact.estimator);
  command->add_option("--seed", options.seed, "Of random places and orientations")
      ->check(notNegative())
      ->capture_default_str();
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
  command->add_flag("--force", arguments->force, "Replace existing outputs");
  command->footer(
      "Examples:\n"
      "  innersphere scene run pile --png pile.png --html pile.html\n"
      "  innersphere scene run pile --mesh bunny.obj --mesh cow.obj --spheres 2000\n"
      "  innersphere scene run chain --dt 0.0166667 --csv chain.csv --json");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace innersphere::tool

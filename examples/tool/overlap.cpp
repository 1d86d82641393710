#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string_view>

#include "commands.hpp"
#include "contact_arguments.hpp"
#include "exit_codes.hpp"
#include "innersphere/bounded_query.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packer.hpp"
#include "innersphere/packing_file.hpp"
#include "innersphere/query.hpp"
#include "innersphere/solids.hpp"
#include "inputs.hpp"
#include "outputs.hpp"
#include "pose_table.hpp"
#include "shard.hpp"
#include "terminal.hpp"

namespace innersphere::tool {
namespace {

constexpr std::size_t kBatch = 256;  // poses queried at once: bounds the memory for their contacts

// Which force the table holds.
enum class Force {
  by_estimator,  ///< gradient for volume-true and surface, volume for raw
  gradient,      ///< sum pi a^2 n: minus the gradient of the overlap volume
  volume         ///< sum V n: the paper's
};

struct Arguments {
  std::string a;
  std::string b;
  std::string poses;
  std::string output;
  std::size_t spheres = 0;
  QueryOptions query;
  QueryContextOptions context;
  std::string device;
  Force force_law = Force::by_estimator;
  Shard shard;
  bool force = false;
};

Vec3d plus(const Vec3d& a, const Vec3d& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec3d minus(const Vec3d& a, const Vec3d& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <typename T>
Vec3d wide(const std::array<T, 3>& v) {
  return {v[0], v[1], v[2]};
}

// Centre of the bounding box of a solid, or of its spheres if the file has no surface; in the packing's
// frame.
Vec3d boxCentre(const Packing& packing) {
  Vec3d low{1e300, 1e300, 1e300};
  Vec3d high{-1e300, -1e300, -1e300};
  const auto include = [&](const Vec3d& p, double radius) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k] - radius);
      high[k] = std::max(high[k], p[k] + radius);
    }
  };
  for (const auto& v : packing.surface.vertices) include(wide(v), 0);
  if (packing.surface.vertices.empty()) {
    for (const Sphere& s : packing.spheres) include({s.x, s.y, s.z}, s.radius);
  }
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

Vec3d moved(const Placement& placement, const Vec3d& p) {
  Vec3d result = placement.translation;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) result[i] += placement.rotation[3 * i + j] * p[j];
  }
  return result;
}

struct Wrench {
  Vec3d force{};
  Vec3d torque{};
};

// A's packing is not moved, so points of the result are in its frame.
Wrench volumeWrench(const Overlap& overlap, const Placement& b, const Vec3d& reference) {
  return {overlap.force, plus(overlap.torque, cross(minus(b.translation, reference), overlap.force))};
}

Wrench gradientWrench(const QueryResult& result, std::size_t query, const Vec3d& reference) {
  Wrench wrench;
  wrench.force = result.overlaps[query].area;
  const auto& contacts = result.contacts_a;
  for (std::size_t i = contacts.first[query]; i < contacts.first[query + 1]; ++i) {
    const SphereContact& contact = contacts.items[i];
    wrench.torque = plus(wrench.torque, cross(minus(wide(contact.centroid), reference), wide(contact.area)));
  }
  return wrench;
}

void appendRow(std::string& table, const std::string& name, const Overlap& overlap, const Wrench& wrench,
               const ExpectedError& error) {
  table += name;
  const auto number = [&table](double value) {
    char text[40];
    std::snprintf(text, sizeof text, ",%.12g", std::isnan(value) ? std::abs(value) : value);  // never -nan
    table += text;
  };
  number(overlap.volume);
  for (const double x : overlap.centroid) number(x);
  for (const double x : wrench.force) number(x);
  for (const double x : wrench.torque) number(x);
  number(overlap.stiffness);
  table += ',' + std::to_string(overlap.pair_count);
  number(error.mean);
  number(error.bound);
  table += '\n';
}

std::uint32_t prefixOf(const Arguments& arguments, const Packing& packing, const std::string& name) {
  const std::size_t count = packing.spheres.size();
  if (arguments.spheres <= count) return static_cast<std::uint32_t>(arguments.spheres);
  say(name + " has only " +
      (count == 1 ? "one sphere" : std::to_string(count) + " spheres: all of them are used"));
  return 0;
}

// Triangles are exact unless they enclose a part of the solid twice, or chords leave one out.
void sayIfInexact(const CollisionModel& model, const std::string& name) {
  PairQuery with_itself;
  with_itself.a = with_itself.b = &model;
  if (!std::isnan(expectedError(with_itself, Estimator::surface, {}).mean)) return;
  say("the triangles of " + name +
      " enclose another volume than the solid has, as those of shells that overlap or of round faces do: "
      "errors of overlaps are unknown (nan)");
}

std::shared_ptr<const CollisionModel> modelOf(const std::string& source, std::size_t spheres) {
  const std::size_t to_pack = spheres > 0 ? spheres : PackOptions().spheres;
  return std::make_shared<CollisionModel>(std::make_shared<Packing>(loadOrPack(source, to_pack)));
}

// 64-bit FNV-1a (Fowler, Noll, Vo): std::hash may differ between builds, and shards of one job come from many
// machines.
std::uint64_t digest(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  return hash;
}

// All that the numbers of the table depend on, as 16 hexadecimal digits.
std::string jobOf(const PairQuery& query, const QueryOptions& options, const std::vector<NamedPose>& poses) {
  std::string all = encodePacking(query.a->packing()) + encodePacking(query.b->packing());
  for (const std::uint64_t word : {std::uint64_t{query.prefix_a}, std::uint64_t{query.prefix_b},
                                   std::uint64_t(options.want), std::uint64_t(options.estimator)}) {
    all += std::to_string(word) + ' ';
  }
  for (const NamedPose& pose : poses) {
    all += pose.name;
    all.append(reinterpret_cast<const char*>(&pose.placement), sizeof pose.placement);
  }
  char text[20];
  std::snprintf(text, sizeof text, "%016" PRIx64, digest(all));
  return text;
}

int deviceOf(const std::string& name) {
  if (name.empty()) return kCurrentDevice;
  if (name == "all") return kAllDevices;
  int number = -1;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc() || end != name.data() + name.size() || number < 0) {
    throw Error(ErrorCode::bad_argument,
                "--device is the number of a CUDA device, from 0 on, or all; not " + name);
  }
  return number;
}

void run(Arguments& arguments) {
  checkOutput(arguments.output, arguments.force);
  arguments.context.device = deviceOf(arguments.device);
  std::vector<NamedPose> poses = readPoses(arguments.poses);
  QueryContext context(arguments.context);
  const auto a = modelOf(arguments.a, arguments.spheres);
  const auto b = arguments.b == arguments.a ? a : modelOf(arguments.b, arguments.spheres);
  clearProgressBar();

  const Vec3d centre = boxCentre(b->packing());
  const bool on_surfaces = arguments.query.estimator == Estimator::surface;
  if (on_surfaces && arguments.force_law == Force::volume) {
    throw Error(ErrorCode::bad_argument,
                "--force-law volume is a sum over spheres, which --estimator surface does not make");
  }
  // The force of a query with surfaces is the gradient already.
  const bool from_contacts =
      !on_surfaces &&
      (arguments.force_law == Force::gradient ||
       (arguments.force_law == Force::by_estimator && arguments.query.estimator == Estimator::volume_true));
  arguments.query.want = from_contacts ? Want::contacts : Want::wrench;
  PairQuery query;
  query.a = a.get();
  query.b = b.get();
  query.prefix_a = prefixOf(arguments, a->packing(), arguments.a);
  query.prefix_b = b == a ? query.prefix_a : prefixOf(arguments, b->packing(), arguments.b);

  std::string table;
  if (!arguments.shard.whole()) {
    table = toText({arguments.shard, poses.size(), jobOf(query, arguments.query, poses)});
    poses = {poses.begin() + static_cast<std::ptrdiff_t>(arguments.shard.firstRow(poses.size())),
             poses.begin() + static_cast<std::ptrdiff_t>(arguments.shard.endRow(poses.size()))};
  }
  table += "pose,volume,cx,cy,cz,fx,fy,fz,tx,ty,tz,stiffness,pairs,error,error_bound\n";
  QueryResult result;
  const Progress progress = progressBar();
  for (std::size_t first = 0; first < poses.size(); first += kBatch) {
    std::vector<PairQuery> queries(std::min(kBatch, poses.size() - first), query);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      Placement& place = queries[i].placement_b = placed(b->packing(), poses[first + i].placement);
      place.translation = minus(place.translation, a->packing().origin);
    }
    context.run(queries.data(), queries.size(), arguments.query, result);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Placement& place = queries[i].placement_b;
      const Vec3d reference = moved(place, centre);
      Overlap& overlap = result.overlaps[i];
      const Wrench wrench =
          from_contacts ? gradientWrench(result, i, reference) : volumeWrench(overlap, place, reference);
      if (overlap.volume > 0) overlap.centroid = plus(overlap.centroid, a->packing().origin);
      appendRow(table, poses[first + i].name, overlap, wrench,
                expectedError(queries[i], arguments.query.estimator, overlap));
    }
    if (!progress("querying",
                  static_cast<double>(first + queries.size()) / static_cast<double>(poses.size()))) {
      throw Error(ErrorCode::cancelled, "the query was cancelled");
    }
  }
  clearProgressBar();
  if (on_surfaces) {
    sayIfInexact(*a, arguments.a);
    if (b != a) sayIfInexact(*b, arguments.b);
  }
  writeTextOutput(arguments.output, arguments.force, table);
}

}  // namespace

Command overlapCommand() {
  Command command("overlap", "Measure the overlap of two packings in many poses");
  auto arguments = std::make_shared<Arguments>();
  command.argument("A", arguments->a, "Packing file, mesh file or name of a solid; not moved")
      .withFile()
      .withSuggestions(namedSolids());
  command.argument("B", arguments->b, "The same for the body that is moved")
      .withFile()
      .withSuggestions(namedSolids());
  Option& poses = command.text(
      "--poses", arguments->poses,
      "CSV file with the columns m00 to m23: the 3x4 matrix that takes B's coordinates to its place");
  poses.withFile().required = true;
  Option& output = command.text("-o,--output", arguments->output, "CSV file to write; -: to stdout");
  output.withFile().required = true;
  command.count("--spheres", arguments->spheres, kNotNegative, "Use the first ones only; 0: all");
  addEstimatorOption(command, arguments->query.estimator, true);
  addBackendOption(command, arguments->context.backend);
  command.text("--device", arguments->device, "Number of the CUDA device; all: they share the poses")
      .withSuggestions({"all"});
  addShardOption(command, arguments->shard);
  command.choice<Force>(
      "--force-law", arguments->force_law,
      {{"by-estimator", Force::by_estimator}, {"gradient", Force::gradient}, {"volume", Force::volume}},
      "Force of the table: minus the gradient of the overlap volume (sum pi a^2 n), or the paper's "
      "(sum V n); by-estimator: gradient for volume-true and surface, volume for raw");
  command.flag("--force", arguments->force, "Replace an existing output");
  command.notes =
      "One row a pose, in A's coordinates: pose, volume [m^3], centroid cx cy cz [m], force on B fx fy fz, "
      "its torque tx ty tz about the centre of B's bounding box, stiffness (sum pi a^2; with surface the "
      "area of B in A) [m^2], overlapping sphere pairs, error and error_bound. Forces are per unit of "
      "pressure (gradient, [m^2]) or of force density (volume, [m^3]). error is the expected |error| of the "
      "volume, relative to the larger of found and true, and error_bound what it exceeds in 1 of 20 cases: "
      "nan where nothing overlaps or no error was measured, and with surface if the triangles do not have "
      "the solid's volume.";
  command.examples = {"innersphere overlap cow.cbor cow.cbor --poses poses.csv --spheres 4000 -o overlap.csv",
                      "innersphere overlap cow.cbor cow.cbor --poses poses.csv --shard 3/8 -o part-3.csv"};
  command.run = [arguments] {
    run(*arguments);
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool

#include "bench_scene.hpp"

#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace innersphere::bench {
namespace {

using Json = nlohmann::json;

std::ifstream open(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file);
  return in;
}

Body bodyOf(const Json& json) {
  Body body;
  body.mesh = json.value("mesh", "");
  body.packing = json.value("packing", "");
  body.hulls = json.value("hulls", std::vector<std::string>());
  body.box = json.value("box", Vec3{});
  body.size = json.at("size");
  body.mass = json.at("mass");
  body.inertia = json.at("inertia");
  body.position = json.at("position");
  body.rotation = json.at("rotation");
  body.path = json.value("path", Schedule());
  body.force = json.value("force", Schedule());
  if (json.contains("hinge")) {
    const Json& hinge = json["hinge"];
    body.hinge = {true, hinge.at("axis"), hinge.value("speed", 0.0), hinge.value("torque", 0.0),
                  hinge.value("damping", 0.0)};
  }
  return body;
}

// Of all threads [s].
double processorTime() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// The most that the process ever had [MB].
double mostMemory() {
  std::ifstream in = open("/proc/self/status");
  std::string word;
  double kilobytes = 0;
  while (in >> word) {
    if (word == "VmHWM:") in >> kilobytes;
  }
  return kilobytes / 1024;
}

}  // namespace

Triangles readObj(const std::string& file) {
  std::ifstream in = open(file);
  Triangles mesh;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Vec3& v = mesh.vertices.emplace_back();
      words >> v[0] >> v[1] >> v[2];
    } else if (kind == "f") {
      auto& triangle = mesh.triangles.emplace_back();
      for (auto& corner : triangle) {
        std::string word;
        words >> word;
        corner = static_cast<std::uint32_t>(std::stoul(word)) - 1;  // ends at a slash
      }
    }
  }
  return mesh;
}

Vec3 Body::wayAt(double time) const {
  std::size_t i = 1;
  while (i + 1 < path.size() && path[i][0] < time) ++i;
  const auto &a = path[i - 1], &b = path[i];
  const double part = std::fmin(std::fmax((time - a[0]) / (b[0] - a[0]), 0), 1);
  return {a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2]), a[3] + part * (b[3] - a[3])};
}

Vec3 Body::forceAt(double time) const {
  Vec3 now{};
  for (const auto& entry : force) {
    if (entry[0] <= time + 1e-9) now = {entry[1], entry[2], entry[3]};
  }
  return now;
}

Scene readScene(const std::string& file) {
  const Json json = Json::parse(open(file));
  Scene scene;
  scene.seconds = json.at("seconds");
  scene.friction = json.at("friction");
  scene.has_ground = !json.at("ground").is_null();
  if (scene.has_ground) scene.ground = json["ground"];
  for (const Json& body : json.at("bodies")) scene.bodies.push_back(bodyOf(body));
  return scene;
}

void record(const Scene& scene, int rate, const std::string& out, const std::function<void(double)>& step,
            const std::function<Pose(std::size_t)>& pose) {
  std::ofstream poses(out + ".f64", std::ios::binary);
  const auto write = [&] {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const Pose p = pose(i);
      poses.write(reinterpret_cast<const char*>(p.position.data()), sizeof p.position);
      poses.write(reinterpret_cast<const char*>(p.rotation.data()), sizeof p.rotation);
    }
  };
  write();
  const long steps = std::lround(scene.seconds * rate);
  double cpu = 0, wall = 0;
  for (long i = 0; i < steps; ++i) {
    const auto before = std::chrono::steady_clock::now();
    const double cpu_before = processorTime();
    step(double(i) / rate);
    cpu += processorTime() - cpu_before;
    wall += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    write();
  }
  std::ofstream(out + ".json") << Json{{"cpu_ms", 1e3 * cpu / double(steps)},
                                       {"wall_ms", 1e3 * wall / double(steps)},
                                       {"memory_mb", mostMemory()}};
  if (!poses.flush()) throw std::runtime_error("cannot write " + out + ".f64");
}

}  // namespace innersphere::bench

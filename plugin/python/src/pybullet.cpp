// Jobs for PyBullet's server, prepared by innersphere/pybullet.py.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "bindings.hpp"
#include "innersphere/packing_shape.hpp"
#include "innersphere/pair_overlaps.hpp"
#include "pybullet_interface.hpp"
#include "pybullet_plugin.hpp"
#include "pybullet_world.hpp"

namespace innersphere::python {
namespace {

using namespace nb::literals;
using pybullet::Job;
using pybullet::Plugin;

enum class Solver { bullet, substep };

using Position = std::array<double, 3>;
using Quaternion = std::array<double, 4>;
using Pose = std::pair<Position, Quaternion>;  ///< as PyBullet has them: x y z, x y z w

constexpr std::pair<const char*, Response> kResponses[] = {
    {"compliant", Response::compliant}, {"rigid", Response::rigid}, {"penalty", Response::penalty}};
constexpr std::pair<const char*, Solver> kSolvers[] = {{"bullet", Solver::bullet},
                                                       {"substep", Solver::substep}};

/// A job with what it will have found. Python holds it; the server's thread runs it.
template <typename Result>
struct Waiting {
  std::shared_ptr<Job> job = std::make_shared<Job>();
  std::shared_ptr<Result> found = std::make_shared<Result>();
  int number = 0;

  template <typename Work>
  explicit Waiting(Work work) {
    job->work = [work = std::move(work), found = found](Plugin& plugin) { *found = work(plugin); };
    number = pybullet::announce(job);
  }
  /// Returns what was found, throws what the job threw, or returns nothing if the server did not run it.
  std::optional<Result> result() const {
    pybullet::withdraw(number);
    if (!job->done) return std::nullopt;
    if (job->error) std::rethrow_exception(job->error);
    return *found;
  }
};

template <typename Result>
void bindWaiting(nb::module_& module, const char* name) {
  nb::class_<Waiting<Result>>(module, name)
      .def_ro("number", &Waiting<Result>::number)
      .def("result", &Waiting<Result>::result);
}

Position from(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

Pose from(const btTransform& t) {
  const btQuaternion q = t.getRotation();
  return {from(t.getOrigin()), {q.x(), q.y(), q.z(), q.w()}};
}

btTransform transform(const Pose& pose) {
  const auto& [p, q] = pose;
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::fabs(length - 1) < 1e-3) || !std::isfinite(p[0] + p[1] + p[2])) {
    throw Error(ErrorCode::bad_argument,
                "a pose is a position of finite numbers and a quaternion x y z w of length 1");
  }
  return btTransform(btQuaternion(q[0] / length, q[1] / length, q[2] / length, q[3] / length),
                     btVector3(p[0], p[1], p[2]));
}

/// What attach() compares with what PyBullet says: iterations, gravity, bodies' poses by their numbers.
struct Seen {
  int iterations = 0;
  Position gravity{};
  std::vector<std::pair<int, Pose>> bases;
};

Seen look(Plugin& plugin) {
  btMultiBodyDynamicsWorld& world = plugin.find();
  Seen seen{world.getSolverInfo().m_numIterations, from(world.getGravity()), {}};
  for (int i = 0; i < world.getNumCollisionObjects(); ++i) {
    const btCollisionObject* object = world.getCollisionObjectArray()[i];
    const auto [body, link] = pybullet::numbersOf(*object);
    if (const auto* collider = btMultiBodyLinkCollider::upcast(object)) {
      if (link < 0) seen.bases.emplace_back(body, from(collider->m_multiBody->getBaseWorldTransform()));
    } else if (const btRigidBody* rigid = btRigidBody::upcast(object)) {
      seen.bases.emplace_back(body, from(rigid->getWorldTransform()));
    }
  }
  return seen;
}

/// As a row of the table that overlaps() returns.
struct OverlapRow {
  std::int32_t body_a, link_a, body_b, link_b;
  double volume, depth;
  Position centroid, area, force, torque;
};

std::vector<OverlapRow> overlapRows(Plugin& plugin) {
  std::vector<OverlapRow> rows;
  for (const PairOverlap& pair : pairOverlaps(plugin.world().getDispatcher())) {
    const auto a = pybullet::numbersOf(*pair.a);
    const auto b = pybullet::numbersOf(*pair.b);
    rows.push_back({a.first, a.second, b.first, b.second, pair.volume, pair.depth, from(pair.centroid),
                    from(pair.area), from(pair.force), from(pair.torque)});
  }
  return rows;
}

Pose meshPose(Plugin& plugin, int body, int link) {
  const btCollisionObject& object = plugin.collider(body, link);
  const PackingShape* shape = PackingShape::from(object.getCollisionShape());
  if (shape == nullptr)
    throw std::invalid_argument("link " + std::to_string(link) + " of body " + std::to_string(body) +
                                " has no packing");
  return from(shape->meshTransform(object.getWorldTransform()));
}

ContactOptions contactOptions(const std::string& response, const std::string& backend, double accuracy,
                              double stiffness, double damping) {
  ContactOptions options;
  options.response = parseWord("response", response, kResponses);
  options.backend = parseWord("backend", backend, kBackends);
  options.accuracy = accuracy;
  options.stiffness = stiffness;
  options.damping = damping;
  return options;
}

}  // namespace

void bindPyBullet(nb::module_& module) {
  nb::module_ jobs =
      module.def_submodule("pybullet", "Jobs for PyBullet's server; see innersphere.pybullet.");
  nb::class_<Seen>(jobs, "Seen")
      .def_ro("iterations", &Seen::iterations)
      .def_ro("gravity", &Seen::gravity)
      .def_ro("bases", &Seen::bases);
  bindWaiting<Seen>(jobs, "Look");
  bindWaiting<bool>(jobs, "Order");
  bindWaiting<int>(jobs, "Number");
  bindWaiting<Pose>(jobs, "Place");
  bindWaiting<std::vector<OverlapRow>>(jobs, "Overlaps");
  jobs.attr("api_version") = pybullet::kApiVersion;

  jobs.def("look", [] { return Waiting<Seen>(&look); });
  jobs.def(
      "set_options",
      [](const std::string& response, const std::string& backend, double accuracy, double stiffness,
         double damping, bool two_friction_directions, const std::string& solver) {
        pybullet::Options options{contactOptions(response, backend, accuracy, stiffness, damping),
                                  two_friction_directions, std::nullopt};
        if (parseWord("solver", solver, kSolvers) == Solver::substep) options.substeps = SubstepOptions{};
        return Waiting<bool>([=](Plugin& plugin) {
          plugin.setOptions(options);
          return true;
        });
      },
      "response"_a, "backend"_a, "accuracy"_a, "stiffness"_a, "damping"_a, "two_friction_directions"_a,
      "solver"_a);
  jobs.def(
      "check_link",
      [](int body, int link) {
        return Waiting<bool>([=](Plugin& plugin) {
          plugin.packable(body, link);
          return true;
        });
      },
      "body"_a, "link"_a);
  jobs.def("world_number", [] { return Waiting<int>([](Plugin& plugin) { return plugin.worldNumber(); }); });
  jobs.def(
      "inertial_frame",
      [](int body) {
        return Waiting<Pose>([=](Plugin& plugin) { return from(plugin.inertialFrame(body)); });
      },
      "body"_a);
  jobs.def(
      "set_shape",
      [](int body, int link, const SharedPacking& packing, const Pose& mesh_to_body) {
        auto shape = std::make_shared<std::unique_ptr<PackingShape>>(
            std::make_unique<PackingShape>(packing.model, transform(mesh_to_body)));
        (*shape)->setSphereCount(packing.count);
        return Waiting<bool>([=](Plugin& plugin) {
          plugin.give(body, link, std::move(*shape));
          return true;
        });
      },
      "body"_a, "link"_a, "packing"_a, "mesh_to_body"_a);
  jobs.def(
      "mesh_pose",
      [](int body, int link) {
        return Waiting<Pose>([=](Plugin& plugin) { return meshPose(plugin, body, link); });
      },
      "body"_a, "link"_a);
  jobs.def("release", [] {
    return Waiting<bool>([](Plugin& plugin) {
      plugin.release();
      return true;
    });
  });
  jobs.def("overlaps", [] { return Waiting<std::vector<OverlapRow>>(&overlapRows); });
  nb::class_<OverlapRow>(jobs, "OverlapRow").def_prop_ro("values", [](const OverlapRow& row) {
    return nb::make_tuple(row.body_a, row.link_a, row.body_b, row.link_b, row.volume, row.depth, row.centroid,
                          row.area, row.force, row.torque);
  });
  jobs.def(
      "principal_frame",
      [](const SharedPacking& packing) {
        const PackingShape shape(packing.model);
        btVector3 inertia;
        shape.calculateLocalInertia(1, inertia);
        return std::pair(from(shape.meshToBody().inverse()), from(inertia));
      },
      "packing"_a, "Where the principal frame is in that of the mesh, and the moments of inertia for 1 kg.");
}

}  // namespace innersphere::python

// Runs a scene of the truth bench in the Open Dynamics Engine: bench_ode SCENE.json RATE OUT.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <list>
#include <map>
#include <string>
#include <vector>

#include <ode/ode.h>
#include <CLI/CLI.hpp>

#include "bench_scene.hpp"

namespace {

using namespace innersphere;

constexpr int kIterations = 50;             // of dWorldQuickStep, whose default is 20
constexpr std::size_t kMostContacts = 512;  // of a pair; with 64 a nut leaves its thread
// Against jitter and pops, as its manual advises: what contacts may sink in, over the smallest body's size,
// and how fast they part [m/s].
constexpr double kLayer = 1e-4, kParting = 0.5;

// A mesh as ODE wants it: the arrays must stay.
struct Mesh {
  std::vector<double> vertices;
  std::vector<dTriIndex> triangles;
  dTriMeshDataID data = nullptr;
};

class World {
 public:
  explicit World(const bench::Scene& scene) : scene_(scene) {
    dInitODE2(0);
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, 0, -9.81);
    dWorldSetQuickStepNumIterations(world_, kIterations);
    double smallest = HUGE_VAL;
    for (const bench::Body& body : scene.bodies) smallest = std::fmin(smallest, body.size);
    dWorldSetContactSurfaceLayer(world_, kLayer * smallest);
    dWorldSetContactMaxCorrectingVel(world_, kParting);
    if (scene.has_ground) dCreatePlane(space_, 0, 0, 1, scene.ground);
    for (const bench::Body& body : scene.bodies) addBody(body);
  }

  ~World() {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    for (const Mesh& mesh : meshes_) dGeomTriMeshDataDestroy(mesh.data);
    dCloseODE();
  }

  void step(double time, double dt) {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) drive(i, time, dt);
    dSpaceCollide(space_, this,
                  [](void* self, dGeomID a, dGeomID b) { static_cast<World*>(self)->collide(a, b); });
    for (const dGeomID geom : moving_) rememberPlace(geom);
    dWorldQuickStep(world_, dt);
    dJointGroupEmpty(contacts_);
  }

  bench::Pose pose(std::size_t i) const {
    const dReal* p = dGeomGetPosition(geoms_[i]);
    dQuaternion q;
    dGeomGetQuaternion(geoms_[i], q);
    return {{p[0], p[1], p[2]}, {q[1], q[2], q[3], q[0]}};
  }

 private:
  void drive(std::size_t i, double time, double dt) {
    const bench::Body& body = scene_.bodies[i];
    const dBodyID moved = dGeomGetBody(geoms_[i]);
    if (body.told()) {
      const bench::Vec3 a = body.wayAt(time), b = body.wayAt(time + dt);
      dBodySetPosition(moved, body.position[0] + a[0], body.position[1] + a[1], body.position[2] + a[2]);
      dBodySetLinearVel(moved, (b[0] - a[0]) / dt, (b[1] - a[1]) / dt, (b[2] - a[2]) / dt);
    }
    if (!body.force.empty()) {
      const bench::Vec3 f = body.forceAt(time);
      dBodyAddForce(moved, f[0], f[1], f[2]);
    }
    if (body.hinge.damping > 0) {
      const dReal* spin = dBodyGetAngularVel(moved);
      const double c = -body.hinge.damping;
      dBodyAddTorque(moved, c * spin[0], c * spin[1], c * spin[2]);
    }
  }

  void collide(dGeomID a, dGeomID b) {
    const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
    if (!body_a && !body_b) return;
    const int count = dCollide(a, b, int(kMostContacts), found_.data(), sizeof(dContactGeom));
    for (int i = 0; i < count; ++i) {
      dContact contact{};
      contact.surface.mode = dContactApprox1;
      contact.surface.mu = scene_.friction;
      contact.geom = found_[std::size_t(i)];
      dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_a, body_b);
    }
  }

  // Where a mesh was in the step before: ODE's manual asks for it.
  static void rememberPlace(dGeomID geom) {
    const dReal *p = dGeomGetPosition(geom), *r = dGeomGetRotation(geom);
    const dReal place[16] = {r[0], r[4], r[8],  0, r[1], r[5], r[9], 0,
                             r[2], r[6], r[10], 0, p[0], p[1], p[2], 1};
    dGeomTriMeshSetLastTransform(geom, place);
  }

  dTriMeshDataID dataOf(const std::string& file) {
    dTriMeshDataID& known = known_[file];
    if (known) return known;
    const bench::Triangles read = bench::readObj(file);
    Mesh& mesh = meshes_.emplace_back();
    for (const auto& v : read.vertices) mesh.vertices.insert(mesh.vertices.end(), v.begin(), v.end());
    for (const auto& t : read.triangles) mesh.triangles.insert(mesh.triangles.end(), t.begin(), t.end());
    mesh.data = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildDouble(mesh.data, mesh.vertices.data(), 3 * sizeof(double),
                                int(mesh.vertices.size() / 3), mesh.triangles.data(),
                                int(mesh.triangles.size()), 3 * sizeof(dTriIndex));
    dGeomTriMeshDataPreprocess2(mesh.data, 1u << dTRIDATAPREPROCESS_BUILD_FACE_ANGLES, nullptr);
    return known = mesh.data;
  }

  void addBody(const bench::Body& body) {
    const dGeomID geom = body.mesh.empty()
                             ? dCreateBox(space_, body.box[0], body.box[1], body.box[2])
                             : dCreateTriMesh(space_, dataOf(body.mesh), nullptr, nullptr, nullptr);
    geoms_.push_back(geom);
    if (body.mass > 0 || body.told()) {
      const dBodyID added = dBodyCreate(world_);
      dGeomSetBody(geom, added);
      if (body.mass > 0) {
        dMass mass;
        dMassSetParameters(&mass, body.mass, 0, 0, 0, body.inertia[0], body.inertia[1], body.inertia[2], 0, 0,
                           0);
        dBodySetMass(added, &mass);
      } else {
        dBodySetKinematic(added);
      }
      if (!body.mesh.empty()) moving_.push_back(geom);
    }
    const dQuaternion turned = {body.rotation[3], body.rotation[0], body.rotation[1], body.rotation[2]};
    dGeomSetPosition(geom, body.position[0], body.position[1], body.position[2]);
    dGeomSetQuaternion(geom, turned);
    if (!body.mesh.empty()) rememberPlace(geom);
    if (body.hinge.there) addHinge(body.hinge, dGeomGetBody(geom), body.position);
  }

  void addHinge(const bench::Hinge& hinge, dBodyID body, const bench::Vec3& at) {
    const dJointID joint = dJointCreateHinge(world_, nullptr);
    dJointAttach(joint, body, nullptr);
    dJointSetHingeAnchor(joint, at[0], at[1], at[2]);
    dJointSetHingeAxis(joint, hinge.axis[0], hinge.axis[1], hinge.axis[2]);
    if (hinge.torque <= 0) return;
    dJointSetHingeParam(joint, dParamVel, hinge.speed);
    dJointSetHingeParam(joint, dParamFMax, hinge.torque);
  }

  const bench::Scene& scene_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  std::list<Mesh> meshes_;  // stay where they are
  std::map<std::string, dTriMeshDataID> known_;
  std::vector<dGeomID> geoms_, moving_;
  std::vector<dContactGeom> found_{kMostContacts};
};

// "ODE, OPCODE": what it finds contacts of meshes with.
std::string version() {
  const char* built = dGetConfiguration();
  return std::string("ODE") + (std::strstr(built, "gimpact") ? ", GIMPACT" : ", OPCODE") +
         (std::strstr(built, "double") ? ", double precision" : ", single precision");
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app("Runs a scene of the truth bench in the Open Dynamics Engine.");
  std::string file, out;
  int rate = 240;
  app.add_option("scene", file, "Scene that scene.py prepared")->required()->check(CLI::ExistingFile);
  app.add_option("rate", rate, "Steps a second")->required()->check(CLI::PositiveNumber);
  app.add_option("out", out, "Writes OUT.f64 and OUT.json")->required();
  app.set_version_flag("--version", version());
  CLI11_PARSE(app, count, arguments);
  try {
    const bench::Scene scene = bench::readScene(file);
    World world(scene);
    bench::record(
        scene, rate, out, [&](double time) { world.step(time, 1.0 / rate); },
        [&](std::size_t i) { return world.pose(i); });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_ode: %s\n", error.what());
    return 1;
  }
}

#include "mesh/closest_triangle.hpp"

#include <stdexcept>

namespace innersphere {
namespace {

// Covers the rounding of a query point to float and of Embree's box distances, both relative to unit
// diagonal.
constexpr double kFloatSlack = 1e-6;

float roundedDown(double x) {
  return std::nextafter(static_cast<float>(x), -std::numeric_limits<float>::infinity());
}
float roundedUp(double x) {
  return std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
}

struct Query {
  const std::vector<Triangle>* triangles;
  Vec3d p;
  double to_unit;
  double slack;
  double best2 = std::numeric_limits<double>::infinity();
  unsigned best = 0;
  Vec3d point{};
};

float cullRadius(double distance_unit, double slack) {
  return roundedUp(distance_unit * (1 + kFloatSlack) + slack);
}

bool visitTriangle(RTCPointQueryFunctionArguments* args) {
  Query& query = *static_cast<Query*>(args->userPtr);
  Vec3d point;
  const double d2 = (*query.triangles)[args->primID].closest(query.p, point);
  if (d2 > query.best2 || (d2 == query.best2 && args->primID > query.best)) return false;
  query.best2 = d2;
  query.best = args->primID;
  query.point = point;
  const float radius = cullRadius(std::sqrt(d2) * query.to_unit, query.slack);
  if (!(radius < args->query->radius)) return false;
  args->query->radius = radius;
  return true;
}

}  // namespace

ClosestTriangle::ClosestTriangle(const Mesh& mesh, const char* embree) : device_(rtcNewDevice(embree)) {
  Bounds box = emptyBounds();
  triangles_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    for (std::uint32_t v : t) extend(box, mesh.vertices[v]);
    triangles_.emplace_back(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  }
  centre_ = centre(box);
  to_unit_ = 1 / diagonal(box);

  if (!device_) throw std::runtime_error("Embree could not be started");
  scene_.reset(rtcNewScene(device_.get()));
  struct Source {
    const ClosestTriangle* tree;
    const Mesh* mesh;
  } source{this, &mesh};
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(triangles_.size()));
  rtcSetGeometryUserData(geometry, &source);
  rtcSetGeometryBoundsFunction(
      geometry,
      [](const RTCBoundsFunctionArguments* args) {
        const Source& source = *static_cast<const Source*>(args->geometryUserPtr);
        const Bounds box = source.tree->unitBox(*source.mesh, args->primID);
        RTCBounds& out = *args->bounds_o;
        out.lower_x = roundedDown(box.min[0]);
        out.lower_y = roundedDown(box.min[1]);
        out.lower_z = roundedDown(box.min[2]);
        out.upper_x = roundedUp(box.max[0]);
        out.upper_y = roundedUp(box.max[1]);
        out.upper_z = roundedUp(box.max[2]);
      },
      nullptr);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree could not build its tree over " + std::to_string(triangles_.size()) +
                             " triangles; is there enough memory?");
  }
}

Bounds ClosestTriangle::unitBox(const Mesh& mesh, std::size_t triangle) const {
  Bounds box = emptyBounds();
  for (std::uint32_t v : mesh.triangles[triangle]) extend(box, to_unit_ * (mesh.vertices[v] - centre_));
  return box;
}

ClosestTriangle::Hit ClosestTriangle::find(const Vec3d& p, double cutoff) const {
  const Vec3d q = to_unit_ * (p - centre_);
  const double reach = std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2])});
  Query query{&triangles_, p, to_unit_, kFloatSlack * (1 + reach)};

  RTCPointQuery ball;
  ball.x = static_cast<float>(q[0]);
  ball.y = static_cast<float>(q[1]);
  ball.z = static_cast<float>(q[2]);
  ball.time = 0;
  ball.radius = cullRadius(cutoff * to_unit_, query.slack);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_.get(), &ball, &context, visitTriangle, &query);

  return {query.best2, query.best, query.point};
}

int ClosestTriangle::sideOf(const Vec3d& p, const Triangle& nearest) const {
  const double front = nearest.inFront(p);
  const double rounding = 1e-10 * (1 / to_unit_ + norm(p));
  return std::abs(front) <= rounding ? 0 : front > 0 ? 1 : -1;
}

ClosestTriangle::Nearest ClosestTriangle::closest(const Vec3d& p, double cutoff) const {
  const Hit hit = find(p, cutoff);
  const double distance = std::sqrt(hit.distance2);
  if (!(distance <= cutoff)) return {{std::numeric_limits<double>::infinity(), {}}};
  return {{distance, hit.point}, &triangles_[hit.triangle]};
}

}  // namespace innersphere

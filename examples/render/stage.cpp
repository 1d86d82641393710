#include "stage.hpp"

#include <cmath>
#include <cstring>
#include <vector>

#include "embree.hpp"
#include "film/creases.hpp"
#include "film/palette.hpp"
#include "film/pose.hpp"

namespace innersphere::demo {
namespace {

using Eigen::Vector3f;

const Vector3f kGroundAlbedo(0.83f, 0.83f, 0.84f);

float linear(float srgb) {
  return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

Vector3f linearColour(const Colour& c) {
  return {linear(c.r), linear(c.g), linear(c.b)};
}

template <typename T>
void fillBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, const std::vector<T>& items) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), items.size());
  std::memcpy(buffer, items.data(), items.size() * sizeof(T));
}

// A shape as Embree sees it, built once however many actors have it.
struct Prop {
  RTCScene scene = nullptr;
  bool as_spheres = false;
  ShadedSurface surface;
  std::vector<Vector3f> sphere_colours;
};

RTCGeometry sphereGeometry(RTCDevice device, const std::vector<Sphere>& spheres) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  fillBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, spheres);
  return geometry;
}

RTCGeometry triangleGeometry(RTCDevice device, const ShadedSurface& surface) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  fillBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, surface.vertices);
  fillBuffer(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, surface.triangles);
  return geometry;
}

RTCRay makeRay(const Vector3f& origin, const Vector3f& direction) {
  RTCRay ray{};
  ray.org_x = origin.x(), ray.org_y = origin.y(), ray.org_z = origin.z();
  ray.dir_x = direction.x(), ray.dir_y = direction.y(), ray.dir_z = direction.z();
  ray.tfar = std::numeric_limits<float>::infinity();
  ray.mask = 0xffffffffu;
  return ray;
}

}  // namespace

struct Stage::Impl {
  const Film& film;
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene world = rtcNewScene(device);
  std::vector<Prop> props;
  std::vector<Eigen::Matrix3f> rotations;
  std::vector<Vector3f> colours;

  explicit Impl(const Film& f) : film(f) {}
  ~Impl() {
    rtcReleaseScene(world);
    for (const Prop& prop : props) rtcReleaseScene(prop.scene);
    rtcReleaseDevice(device);
  }

  void addProp(const Shape& shape, View view) {
    Prop& prop = props.emplace_back();
    prop.as_spheres = shape.surface.triangles.empty() || (view == View::spheres && !shape.spheres.empty());
    prop.scene = rtcNewScene(device);
    if (!prop.as_spheres) prop.surface = splitCreases(shape.surface);
    if (prop.as_spheres && film.colour_by_radius) {
      for (const Colour& c : radiusColours(shape.spheres)) prop.sphere_colours.push_back(linearColour(c));
    }
    RTCGeometry geometry =
        prop.as_spheres ? sphereGeometry(device, shape.spheres) : triangleGeometry(device, prop.surface);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(prop.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(prop.scene);
  }

  void addActor(unsigned index, const Pose& pose) {
    const Eigen::Isometry3f to_world = transformOf(pose);
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, props[film.actors[index].shape].scene);
    const Eigen::Matrix<float, 3, 4> matrix = to_world.matrix().topRows<3>();
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix.data());
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(world, instance, index);
    rtcReleaseGeometry(instance);
    rotations.push_back(to_world.linear());
    colours.push_back(linearColour(film.actors[index].colour));
  }

  Hit describe(const RTCRayHit& ray) const {
    const unsigned actor = ray.hit.instID[0];
    const Prop& prop = props[film.actors[actor].shape];
    const unsigned primitive = ray.hit.primID;
    Hit hit;
    hit.distance = ray.ray.tfar;
    hit.albedo = prop.sphere_colours.empty() ? colours[actor] : prop.sphere_colours[primitive];
    const Vector3f direction(ray.ray.dir_x, ray.ray.dir_y, ray.ray.dir_z);
    const Vector3f facet =
        (rotations[actor] * Vector3f(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z)).normalized();
    const float side = facet.dot(direction) > 0 ? -1.0f : 1.0f;  // -1: seen from behind
    hit.normal = side * facet;
    if (prop.as_spheres) return hit;
    const auto& corners = prop.surface.triangles[primitive];
    const float weights[3] = {1 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v};
    Vector3f smooth = Vector3f::Zero();
    for (int k = 0; k < 3; ++k) {
      const auto& n = prop.surface.normals[corners[k]];
      smooth += weights[k] * Vector3f(n[0], n[1], n[2]);
    }
    smooth = side * (rotations[actor] * smooth).normalized();
    // Near its outline a facet can face the viewer while its interpolated normal does not.
    if (smooth.dot(direction) < 0) hit.normal = smooth;
    return hit;
  }
};

Stage::Stage(const Film& film, std::size_t frame, View view) : impl_(std::make_unique<Impl>(film)) {
  for (const Shape& shape : film.shapes) impl_->addProp(shape, view);
  for (unsigned i = 0; i < film.actors.size(); ++i) impl_->addActor(i, film.frame(frame)[i]);
  rtcCommitScene(impl_->world);
}

Stage::~Stage() = default;

std::optional<Hit> Stage::intersect(const Vector3f& origin, const Vector3f& direction) const {
  RTCRayHit ray{};
  ray.ray = makeRay(origin, direction);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersectRay(impl_->world, ray);
  const bool found = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;

  if (impl_->film.has_ground && direction.z() < 0) {
    const float distance = (impl_->film.ground - origin.z()) / direction.z();
    if (distance > 0 && !(found && ray.ray.tfar < distance)) {
      return Hit{distance, Vector3f::UnitZ(), kGroundAlbedo, true};
    }
  }
  if (!found) return std::nullopt;
  return impl_->describe(ray);
}

bool Stage::occluded(const Vector3f& origin, const Vector3f& direction) const {
  RTCRay ray = makeRay(origin, direction);
  occludeRay(impl_->world, ray);
  return ray.tfar < 0;
}

}  // namespace innersphere::demo

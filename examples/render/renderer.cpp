#include "renderer.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "camera.hpp"
#include "innersphere/error.hpp"
#include "sampler.hpp"
#include "stage.hpp"

namespace innersphere::demo {
namespace {

using Eigen::Vector3f;

constexpr float kPi = 3.14159265f;

// Two directions that complete `z` to an orthonormal frame.
Eigen::Matrix3f frameAround(const Vector3f& z) {
  Eigen::Matrix3f frame;
  frame.col(0) = z.unitOrthogonal();
  frame.col(1) = z.cross(frame.col(0));
  frame.col(2) = z;
  return frame;
}

// A studio: a warm key light over the camera's left shoulder, a bright sky above, a pale backdrop.
struct Light {
  Eigen::Matrix3f key;                             // frame around the direction to the key light
  const Vector3f key_colour{0.80f, 0.75f, 0.67f};  // on a surface that faces it, times its albedo
  const float key_size = 0.09f;  // tangent of the angle that its disc covers: softness of the shadows

  explicit Light(const Camera& camera) {
    const Vector3f level = Vector3f(camera.forward.x(), camera.forward.y(), 0).normalized();
    key = frameAround((-0.55f * level - 0.75f * camera.right + 1.15f * Vector3f::UnitZ()).normalized());
  }

  Vector3f towardsKey(float u, float v) const {
    const float radius = key_size * std::sqrt(u);
    return (key * Vector3f(radius * std::cos(2 * kPi * v), radius * std::sin(2 * kPi * v), 1)).normalized();
  }

  Vector3f sky(const Vector3f& direction) const {
    const float up = std::clamp(0.5f + 0.5f * direction.z(), 0.0f, 1.0f);
    return Vector3f(0.34f, 0.34f, 0.35f) * (1 - up) + Vector3f(0.40f, 0.45f, 0.53f) * up;
  }

  // What is seen where there is nothing: darkens gently towards the top of the picture.
  Vector3f backdrop(const Vector3f& direction) const {
    const float t = std::clamp(direction.z() + 0.6f, 0.0f, 1.0f);
    return Vector3f(0.80f, 0.81f, 0.82f) * (1 - t) + Vector3f(0.48f, 0.55f, 0.63f) * t;
  }
};

class Painter {
 public:
  Painter(const Stage& stage, const Camera& camera)
      : stage_(stage), camera_(camera), light_(camera), lift_(1e-4f * camera.distance) {}

  Vector3f radiance(const Vector3f& direction, const std::array<float, Sampler::kDimensions>& random) const {
    const auto hit = stage_.intersect(camera_.eye, direction);
    if (!hit) return light_.backdrop(direction);
    const Vector3f point = camera_.eye + hit->distance * direction + lift_ * hit->normal;
    const Vector3f to_key = light_.towardsKey(random[2], random[3]);
    const float key = keyLight(point, hit->normal, to_key);

    const Vector3f bounce = cosineDirection(hit->normal, random[4], random[5]);
    const Vector3f indirect = incoming(point, bounce, to_key);
    Vector3f colour = hit->albedo.cwiseProduct(key * light_.key_colour + indirect);
    if (hit->ground) return fadeOut(colour, hit->distance, direction);
    return colour + gloss(*hit, direction, to_key, key, indirect);
  }

 private:
  float keyLight(const Vector3f& point, const Vector3f& normal, const Vector3f& to_key) const {
    const float cosine = normal.dot(to_key);
    if (cosine <= 0 || stage_.occluded(point, to_key)) return 0;
    return cosine;
  }

  static Vector3f cosineDirection(const Vector3f& normal, float u, float v) {
    const float r = std::sqrt(u);
    const Vector3f local(r * std::cos(2 * kPi * v), r * std::sin(2 * kPi * v),
                         std::sqrt(std::max(0.0f, 1 - u)));
    return (frameAround(normal) * local).normalized();
  }

  // Light that arrives along a ray: the sky, or what the first thing in the way reflects. What reaches that
  // thing indirectly is not traced any further; a part of the sky stands for it.
  Vector3f incoming(const Vector3f& origin, const Vector3f& direction, const Vector3f& to_key) const {
    const auto hit = stage_.intersect(origin, direction);
    if (!hit) return light_.sky(direction);
    const Vector3f point = origin + hit->distance * direction + lift_ * hit->normal;
    const Vector3f ambient = 0.35f * light_.sky(hit->normal);
    return hit->albedo.cwiseProduct(keyLight(point, hit->normal, to_key) * light_.key_colour + ambient);
  }

  // A thin clear coat: a highlight of the key light and a rim that mirrors the surroundings, after Schlick's
  // Fresnel term but held back at grazing angles, where interpolated normals are poor.
  Vector3f gloss(const Hit& hit, const Vector3f& direction, const Vector3f& to_key, float key,
                 const Vector3f& indirect) const {
    const float facing = std::clamp(-hit.normal.dot(direction), 0.0f, 1.0f);
    const float fresnel = 0.04f + 0.6f * std::pow(1 - facing, 5.0f);
    Vector3f result = 0.5f * fresnel * indirect;
    if (key > 0) {
      const Vector3f half = (to_key - direction).normalized();
      const float peak = std::pow(std::max(0.0f, hit.normal.dot(half)), 60.0f);
      result += 0.4f * peak * light_.key_colour;
    }
    return result;
  }

  // The floor melts into the backdrop, so that the picture has no horizon.
  Vector3f fadeOut(const Vector3f& colour, float distance, const Vector3f& direction) const {
    const float t = std::clamp((distance / camera_.distance - 1.2f) / 2.5f, 0.0f, 1.0f);
    const float smooth = t * t * (3 - 2 * t);
    return (1 - smooth) * colour + smooth * light_.backdrop(direction);
  }

  const Stage& stage_;
  const Camera& camera_;
  const Light light_;
  const float lift_;  // [m] keeps rays off the surface they start from
};

// `dither`, from 0 to 1, hides the steps between neighbouring values.
std::uint8_t encode(float linear, float dither) {
  // A soft shoulder above 0.8 keeps highlights from burning out.
  if (linear > 0.8f) linear = 0.8f + 0.2f * (1 - std::exp(-(linear - 0.8f) / 0.2f));
  const float srgb =
      linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(std::max(linear, 0.0f), 1 / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::clamp(srgb * 255 + dither, 0.0f, 255.0f));
}

// The line between the two halves of a split picture leans a little; positive on the right of it. [pixels]
float rightOfSplit(float x, float y, const RenderOptions& options) {
  constexpr float kLean = 0.12f;
  return (x - 0.5f * options.width + kLean * (y - 0.5f * options.height)) / std::sqrt(1 + kLean * kLean);
}

}  // namespace

Image render(const Film& film, std::size_t frame, const RenderOptions& options, const Progress& progress) {
  const Camera camera = frameCamera(film, frame, static_cast<double>(options.width) / options.height);
  std::unique_ptr<Stage> surfaces;
  std::unique_ptr<Stage> spheres;
  if (options.view != View::spheres) surfaces = std::make_unique<Stage>(film, frame, View::surface);
  if (options.view != View::surface) spheres = std::make_unique<Stage>(film, frame, View::spheres);
  const Painter left(surfaces ? *surfaces : *spheres, camera);
  const Painter right(spheres ? *spheres : *surfaces, camera);
  const float half_line = options.view == View::split ? 0.0014f * options.width : -1.0f;

  Image image(options.width, options.height);
  const auto drawPixel = [&](int px, int py) {
    const Sampler sampler(static_cast<std::uint32_t>(px), static_cast<std::uint32_t>(py));
    Vector3f sum = Vector3f::Zero();
    for (int s = 0; s < options.samples; ++s) {
      const auto random = sampler.sample(s);
      const float x = static_cast<float>(px) + random[0];
      const float y = static_cast<float>(py) + random[1];
      const float side = rightOfSplit(x, y, options);
      if (std::abs(side) < half_line) {
        sum += Vector3f::Ones();
        continue;
      }
      const Vector3f direction = camera.direction(2 * x / options.width - 1, 1 - 2 * y / options.height);
      sum += (side < 0 ? left : right).radiance(direction, random).cwiseMin(4.0f);
    }
    const auto dither = sampler.sample(options.samples);
    for (int k = 0; k < 3; ++k) {
      image.pixel(px, py)[k] = encode(sum[k] / static_cast<float>(options.samples), dither[k]);
    }
  };

  constexpr int kBand = 8;  // rows between two reports
  for (int top = 0; top < options.height; top += kBand) {
    if (progress && !progress("drawing", static_cast<double>(top) / options.height)) {
      throw Error(ErrorCode::cancelled, "the picture was cancelled");
    }
    const int bottom = std::min(top + kBand, options.height);
    tbb::parallel_for(0, (bottom - top) * options.width,
                      [&](int i) { drawPixel(i % options.width, top + i / options.width); });
  }
  if (progress) progress("drawing", 1);
  return image;
}

}  // namespace innersphere::demo

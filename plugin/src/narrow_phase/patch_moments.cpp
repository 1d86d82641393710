#include "narrow_phase/patch_moments.hpp"

#include "common/bullet_vectors.hpp"
#include "common/contact_tolerances.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// Tangents that turn smoothly with the reference axes: points keep their places from step to step.
void setTangents(const btMatrix3x3& reference, PatchMoments& moments) {
  const btVector3 inside = moments.normal * reference;
  const btVector3 axis = reference.getColumn(inside.absolute().minAxis());
  moments.tangent[0] = (axis - moments.normal * axis.dot(moments.normal)).normalized();
  moments.tangent[1] = moments.normal.cross(moments.tangent[0]);
}

}  // namespace

PatchMoments patchMoments(const std::vector<SphereContact>& contacts, const std::vector<std::size_t>& indices,
                          const btMatrix3x3& reference) {
  PatchMoments m;
  btVector3 sum(0, 0, 0), volume_moment(0, 0, 0);
  btScalar weights = 0;
  for (std::size_t i : indices) {
    const btVector3 area = toBullet(contacts[i].area);
    const btVector3 x = toBullet(contacts[i].centroid);
    const btScalar weight = area.length();
    sum += area;
    weights += weight;
    m.centre += x * weight;
    m.volume += contacts[i].volume;
    volume_moment += x * contacts[i].volume;
  }
  m.area = sum.length();
  if (!(m.area > 0) || !(weights > 0)) return m;
  m.normal = sum / m.area;
  m.centre /= weights;
  setTangents(reference, m);

  for (std::size_t i : indices) {
    const btVector3 x = toBullet(contacts[i].centroid) - m.centre;
    const btScalar area = toBullet(contacts[i].area).length(), weight = area / weights;
    const btScalar u = x.dot(m.tangent[0]), v = x.dot(m.tangent[1]);
    m.spread[0] += weight * u * u;
    m.spread[1] += weight * u * v;
    m.spread[2] += weight * v * v;
    // A disc is on average d + s^2 / (8 d) away, as far as it is small.
    m.radius += weight * btSqrt(u * u + v * v + area / (4 * SIMD_PI));
  }
  // A depth that slopes by s over the patch moves the centre of volume by spread * s / mean depth.
  if (m.volume > 0) {
    const btVector3 shift = volume_moment / m.volume - m.centre;
    const btScalar u = shift.dot(m.tangent[0]), v = shift.dot(m.tangent[1]);
    const btScalar depth = m.volume / m.area;
    const btScalar det = m.spread[0] * m.spread[2] - m.spread[1] * m.spread[1];
    const btScalar trace = m.spread[0] + m.spread[2];
    if (det > kThinPatch * trace * trace) {
      m.slope[0] = depth * (m.spread[2] * u - m.spread[1] * v) / det;
      m.slope[1] = depth * (m.spread[0] * v - m.spread[1] * u) / det;
    }
  }
  return m;
}

void pointsFromMoments(const PatchMoments& m, btScalar spacing, ContactPatch& patch) {
  patch.count = 0;
  const btScalar depth = m.volume / m.area;
  if (!(depth > 0)) return;
  // Symmetric square root of the spread: the corners move smoothly with it, without picking axes.
  const btScalar root_det = btSqrt(btMax(btScalar(0), m.spread[0] * m.spread[2] - m.spread[1] * m.spread[1]));
  const btScalar norm = btSqrt(m.spread[0] + m.spread[2] + 2 * root_det);
  btScalar r[3] = {0, 0, 0};
  if (norm > 0) {
    r[0] = (m.spread[0] + root_det) / norm;
    r[1] = m.spread[1] / norm;
    r[2] = (m.spread[2] + root_det) / norm;
  }
  const btScalar root3 = btSqrt(btScalar(3));
  // Corners push three times as far out, squared, as the patch does on average: a third of its slope turns
  // the bodies as the volume does.
  const btScalar slope[2] = {m.slope[0] / 3, m.slope[1] / 3};
  btScalar u[kPatchPoints], v[kPatchPoints], steepest = 0;
  for (int i = 0; i < kPatchPoints; ++i) {
    const btScalar su = (i & 1) != 0 ? root3 : -root3, sv = (i & 2) != 0 ? root3 : -root3;
    u[i] = r[0] * su + r[1] * sv;
    v[i] = r[1] * su + r[2] * sv;
    steepest = btMax(steepest, btFabs(slope[0] * u[i] + slope[1] * v[i]));
  }
  // No corner is lifted out of the contact: the sum of the forces is then that of the volume.
  const btScalar tilt = steepest > depth ? depth / steepest : btScalar(1);
  for (int corner = 0; corner < kPatchPoints; ++corner) {
    ContactPoint point;
    point.normal = m.normal;
    point.depth = depth + tilt * (slope[0] * u[corner] + slope[1] * v[corner]);
    const btVector3 middle = m.centre + m.tangent[0] * u[corner] + m.tangent[1] * v[corner];
    point.on_b = middle - m.normal * (point.depth / 2);
    point.id = static_cast<std::uint64_t>(corner);
    bool apart = true;
    for (int i = 0; i < patch.count; ++i) {
      apart = apart && (patch.points[i].on_b - point.on_b).length2() > spacing * spacing;
    }
    if (apart) patch.points[patch.count++] = point;
  }
  // A patch too small for corners keeps one point in its middle.
  if (patch.count == 1) {
    patch.points[0].depth = depth;
    patch.points[0].on_b = m.centre - m.normal * (depth / 2);
  }
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere

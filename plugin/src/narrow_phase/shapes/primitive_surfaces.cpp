// Spheres, boxes, capsules, cylinders, cones and all other convex shapes.
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include "common/bullet_vectors.hpp"
#include "narrow_phase/shapes/distance_surface.hpp"

namespace innersphere {
inline namespace INNERSPHERE_BULLET_PRECISION {
namespace {

/// A shape of one class, which has changed where its box has.
template <typename Shape>
class PrimitiveSurface : public DistanceSurface {
 public:
  explicit PrimitiveSurface(const btCollisionShape& shape) : shape_(static_cast<const Shape&>(shape)) {}

  bool isAsBefore() override { return boxIsAsBefore(shape_); }

  /// As if its face were flat there.
  bool depthOf(const PlacedPacking& body, const btTransform& world, const btVector3& place,
               const btVector3& out, btScalar most, btScalar& depth) override {
    const btVector3 along = out * world.getBasis();
    const btVector3 outermost = shape_.localGetSupportingVertex(along);
    depth = (outermost - world.invXform(body.origin() + place)).dot(along);
    return depth > 0 && depth < most;
  }

 protected:
  const Shape& shape_;
};

/// Signed distance of a point at `offset` from the nearest point of a core that is thickened by `radius`.
/// `normal` is the outward direction, `fallback` where the point lies on the core.
btScalar thickenedDistance(const btVector3& offset, btScalar radius, const btVector3& fallback,
                           btVector3& normal) {
  const btScalar length = offset.length();
  normal = length > SIMD_EPSILON * radius ? offset / length : fallback;
  return length - radius;
}

class SphereSurface : public PrimitiveSurface<btSphereShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    nearest.distance = thickenedDistance(p, shape_.getRadius(), btVector3(0, 1, 0), nearest.normal);
    nearest.curvature = 1 / shape_.getRadius();
    return true;
  }
};

class CapsuleSurface : public PrimitiveSurface<btCapsuleShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    const int axis = shape_.getUpAxis();
    const btScalar half = shape_.getHalfHeight();
    btVector3 offset = p;
    offset[axis] -= btClamped(p[axis], -half, half);
    btVector3 sideways(0, 0, 0);
    sideways[(axis + 1) % 3] = 1;
    if (offset[axis] == 0) nearest.straight[axis] = 1;
    nearest.distance = thickenedDistance(offset, shape_.getRadius(), sideways, nearest.normal);
    nearest.curvature = 1 / shape_.getRadius();
    return true;
  }

  bool lineTowards(const btVector3& direction, btVector3 (&ends)[2]) const override {
    const int axis = shape_.getUpAxis();
    for (const int end : {0, 1}) {
      ends[end] = direction * shape_.getRadius();
      ends[end][axis] += shape_.getHalfHeight() * btScalar(end == 0 ? -1 : 1);
    }
    return true;
  }
};

class BoxSurface : public PrimitiveSurface<btBoxShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    const btVector3 half = shape_.getHalfExtentsWithMargin();
    const btVector3 beyond = p.absolute() - half;
    btVector3 outside = beyond;
    outside.setMax(btVector3(0, 0, 0));
    const btScalar length = outside.length();
    if (length > 0) {
      nearest.distance = length;
      nearest.normal = outside / length;
      if (length > outside[outside.maxAxis()]) {
        nearest.edged = &shape_;
        nearest.edge_curvature = BT_LARGE_FLOAT;
        if (!(outside[outside.minAxis()] > 0)) nearest.straight[outside.minAxis()] = 1;
      }
    } else {
      const int axis = beyond.maxAxis();
      nearest.distance = beyond[axis];
      nearest.normal.setZero();
      nearest.normal[axis] = 1;
    }
    for (int i = 0; i < 3; ++i) {
      if (p[i] < 0) nearest.normal[i] = -nearest.normal[i];
    }
    return true;
  }

  const btPolyhedralConvexShape* polyhedron() const override { return &shape_; }
};

/// A place in the half plane through the axis of a solid of revolution: distance from the axis, height on it.
struct Profile {
  Profile(const btVector3& p, int axis) : height(p[axis]), outwards(p) {
    outwards[axis] = 0;
    radius = outwards.length();
    outwards = radius > 0 ? outwards / radius : btVector3(0, 0, 0);
    if (!(radius > 0)) outwards[(axis + 1) % 3] = 1;
  }
  /// A direction in that half plane.
  btVector3 direction(btScalar out, btScalar up, int axis) const {
    btVector3 along(0, 0, 0);
    along[axis] = up;
    return outwards * out + along;
  }
  /// Unit, across that half plane.
  btVector3 around(int axis) const {
    btVector3 along(0, 0, 0);
    along[axis] = 1;
    return along.cross(outwards);
  }
  btScalar radius;
  btScalar height;
  btVector3 outwards;  ///< unit, from the axis
};

class CylinderSurface : public PrimitiveSurface<btCylinderShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  /// The shape is a cylinder that is smaller by the margin, thickened by it.
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    const int axis = shape_.getUpAxis();
    const btScalar margin = shape_.getMargin(), radius = shape_.getRadius();
    const Profile at(p, axis);
    const btScalar side = at.height < 0 ? btScalar(-1) : btScalar(1);
    const btScalar out = at.radius - (radius - margin),
                   up = btFabs(at.height) - shape_.getHalfExtentsWithoutMargin()[axis];
    if (out > 0 && up > 0) {
      const btScalar length = btSqrt(out * out + up * up);
      nearest.distance = length - margin;
      nearest.normal = at.direction(out / length, side * up / length, axis);
      nearest.curvature = margin > 0 ? 1 / margin : btScalar(0);
      nearest.straight = at.around(axis);
      nearest.along_straight = out / (length * (radius - margin) + margin * out);
      nearest.edged = &shape_;
    } else if (out > up) {
      nearest.distance = out - margin;
      nearest.normal = at.outwards;
      nearest.curvature = 1 / radius;
      nearest.straight[axis] = 1;
    } else {
      nearest.distance = up - margin;
      nearest.normal = at.direction(0, side, axis);
    }
    return true;
  }

  bool lineTowards(const btVector3& direction, btVector3 (&ends)[2]) const override {
    const int axis = shape_.getUpAxis();
    const Profile towards(direction, axis);
    const btScalar half = shape_.getHalfExtentsWithoutMargin()[axis];
    for (const int end : {0, 1})
      ends[end] = towards.direction(shape_.getRadius(), end == 0 ? -half : half, axis);
    return true;
  }
};

class ConeSurface : public PrimitiveSurface<btConeShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 private:
  /// The shape is a cone thickened by the margin: in the half plane, a triangle of tip, rim and middle of the
  /// base.
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    const int axis = shape_.getConeUpIndex();
    const btScalar margin = shape_.getMargin(), radius = shape_.getRadius(), height = shape_.getHeight();
    const Profile at(p, axis);
    const btScalar slant = btSqrt(radius * radius + height * height);
    const btScalar slope_out = height / slant, slope_up = radius / slant;
    // From the rim: along the slope to the tip, and above the slope and the base.
    const btScalar out = at.radius - radius, up = at.height + height / 2;
    const btScalar along = out * -slope_up + up * slope_out;
    const btScalar above = out * slope_out + up * slope_up;
    const auto fromPoint = [&](btScalar x, btScalar y, btScalar from_axis) {
      const btScalar length = btSqrt(x * x + y * y);
      nearest.distance = length - margin;
      nearest.normal = length > 0 ? at.direction(x / length, y / length, axis) : at.outwards;
      nearest.curvature = margin > 0 ? 1 / margin : btScalar(0);
      if (from_axis > 0) {
        nearest.straight = at.around(axis);
        nearest.along_straight = x / (length * from_axis + margin * x);
      }
      nearest.edged = &shape_;
    };
    if (-up >= above && out <= 0) {
      nearest.distance = -up - margin;
      nearest.normal = at.direction(0, -1, axis);
    } else if (along > slant) {
      fromPoint(at.radius, at.height - height / 2, 0);
    } else if (along < 0) {
      fromPoint(out, up, radius);
    } else {
      nearest.distance = above - margin;
      nearest.normal = at.direction(slope_out, slope_up, axis);
      nearest.straight = at.direction(-slope_up, slope_out, axis);
      // Across the slope, at the place where it is nearest.
      const btScalar nearest_radius = radius - along * slope_up + margin * slope_out;
      nearest.curvature = nearest_radius > 0 ? slope_out / nearest_radius : btScalar(0);
    }
    return true;
  }

  bool lineTowards(const btVector3& direction, btVector3 (&ends)[2]) const override {
    const int axis = shape_.getConeUpIndex();
    const btScalar margin = shape_.getMargin(), radius = shape_.getRadius(), height = shape_.getHeight();
    const btScalar slant = btSqrt(radius * radius + height * height);
    const Profile towards(direction, axis);
    const btVector3 out = towards.direction(height / slant, radius / slant, axis) * margin;
    ends[0] = towards.direction(radius, -height / 2, axis) + out;
    ends[1] = towards.direction(0, height / 2, axis) + out;
    return true;
  }
};

/// Any other convex shape, by Bullet's GJK outside and EPA inside. Its margin counts as part of it, as in
/// Bullet.
class ConvexSurface : public PrimitiveSurface<btConvexShape> {
 public:
  using PrimitiveSurface::PrimitiveSurface;

 protected:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    btGjkEpaSolver2::sResults results;
    results.normal.setZero();
    const btScalar distance =
        btGjkEpaSolver2::SignedDistance(p, 0, &shape_, btTransform::getIdentity(), results);
    if (!(btFabs(distance) < BT_LARGE_FLOAT) || !isFinite(results.normal) || results.normal.fuzzyZero())
      return false;
    nearest.distance = distance;
    nearest.normal = results.normal.normalized();
    nearest.edged = &shape_;
    return true;
  }

 private:
  btScalar lowerBound(const btVector3& p) const override { return boxDistance(shape_, p); }
};

/// The hull of spheres. Its distance is the largest that any direction tells, less how far the hull reaches
/// there: that is where one sphere is furthest out, or two, which roll on a line. Where three are, it is
/// flat.
class MultiSphereSurface : public ConvexSurface {
 public:
  explicit MultiSphereSurface(const btMultiSphereShape& spheres)
      : ConvexSurface(spheres), spheres_(spheres) {}

 private:
  struct Ball {
    btVector3 centre;
    btScalar radius;
  };
  /// Of two balls, the direction in which both are furthest out: `along` their line, and across it.
  struct Cone {
    btVector3 line;
    btScalar along, across;
    btVector3 direction(const btVector3& way) const {
      const btVector3 aside = way - line * line.dot(way);
      const btScalar length = aside.length();
      btVector3 any, unused;
      if (!(length > 0)) btPlaneSpace1(line, any, unused);
      return line * along + (length > 0 ? aside / length : any) * across;
    }
  };

  Ball ball(int i) const {
    const btVector3& scaling = spheres_.getLocalScaling();
    return {spheres_.getSpherePosition(i) * scaling, spheres_.getSphereRadius(i) * scaling.x()};
  }
  static bool coneOf(const Ball& a, const Ball& b, Cone& cone) {
    const btVector3 way = b.centre - a.centre;
    const btScalar length = way.length();
    if (!(btFabs(a.radius - b.radius) < length)) return false;  // one lies in the other
    cone.line = way / length;
    cone.along = (a.radius - b.radius) / length;
    cone.across = btSqrt(1 - cone.along * cone.along);
    return true;
  }
  /// Whether nothing of the hull is further out.
  bool isOutermost(const Ball& here, const btVector3& direction) const {
    const btScalar reach = here.centre.dot(direction) + here.radius;
    for (int i = 0; i < spheres_.getSphereCount(); ++i) {
      const Ball other = ball(i);
      const btScalar beyond = other.centre.dot(direction) + other.radius - reach;
      if (beyond > 8 * SIMD_EPSILON * (other.centre.length() + other.radius)) return false;
    }
    return true;
  }

  bool nearest(const btVector3& p, Nearest& nearest) const override {
    nearest.distance = -BT_LARGE_FLOAT;
    for (int i = 0; i < spheres_.getSphereCount(); ++i) {
      const Ball a = ball(i);
      btVector3 normal;
      const btScalar distance = thickenedDistance(p - a.centre, a.radius, btVector3(0, 1, 0), normal);
      if (distance > nearest.distance && isOutermost(a, normal)) {
        nearest.distance = distance;
        nearest.normal = normal;
        nearest.curvature = 1 / a.radius;
        nearest.straight.setZero();
      }
      for (int k = 0; k < i; ++k) {
        const Ball b = ball(k);
        Cone cone;
        if (!coneOf(a, b, cone)) continue;
        normal = cone.direction(p - a.centre);
        const btScalar from_line = (p - a.centre).dot(normal) - a.radius;
        if (!(from_line > nearest.distance) || !isOutermost(a, normal)) continue;
        nearest.distance = from_line;
        nearest.normal = normal;
        nearest.straight = (cone.line - normal * cone.along) / cone.across;
        // Of the ball that touches the line there.
        const btScalar part =
            (p - a.centre).dot(nearest.straight) / (b.centre - a.centre).dot(nearest.straight);
        nearest.curvature =
            1 / (a.radius + btClamped(part, btScalar(0), btScalar(1)) * (b.radius - a.radius));
      }
    }
    // Over a face, which no ball and no line is, GJK knows better.
    Nearest by_gjk;
    if (spheres_.getSphereCount() < 3 || !ConvexSurface::nearest(p, by_gjk))
      return nearest.distance > -BT_LARGE_FLOAT;
    if (by_gjk.distance > nearest.distance + kFlatter * ball(0).radius) nearest = by_gjk;
    return true;
  }

  bool lineTowards(const btVector3& direction, btVector3 (&ends)[2]) const override {
    btScalar furthest = -BT_LARGE_FLOAT;
    for (int i = 0; i < spheres_.getSphereCount(); ++i) {
      for (int k = 0; k < i; ++k) {
        const Ball a = ball(i), b = ball(k);
        Cone cone;
        if (!coneOf(a, b, cone)) continue;
        const btVector3 normal = cone.direction(direction);
        const btScalar reach = normal.dot(direction);
        if (!(reach > furthest) || !isOutermost(a, normal)) continue;
        furthest = reach;
        ends[0] = a.centre + normal * a.radius;
        ends[1] = b.centre + normal * b.radius;
      }
    }
    return furthest > -BT_LARGE_FLOAT;
  }

  /// In radii: what GJK is off by in single precision.
  static constexpr btScalar kFlatter = btScalar(1e-3);
  const btMultiSphereShape& spheres_;
};

/// A polyhedron by its faces: in single precision GJK ends while its normal is still off by up to 3 degrees.
class HullSurface : public ConvexSurface {
 public:
  explicit HullSurface(const btPolyhedralConvexShape& hull) : ConvexSurface(hull), hull_(hull) {}

  bool isFaceted() const override { return true; }

  void findNearSpheres(const PlacedPacking& body, const btTransform& world,
                       std::vector<NearSphere>& near_spheres) override {
    facets_.setHull(hull_);
    DistanceSurface::findNearSpheres(body, world, near_spheres);
  }

 private:
  bool nearest(const btVector3& p, Nearest& nearest) const override {
    Facets::Nearest found;
    if (!facets_.nearest(p, found)) return ConvexSurface::nearest(p, nearest);
    nearest.distance = found.distance;
    nearest.normal = found.normal;
    nearest.edge_curvature = found.edge_curvature;
    nearest.straight = found.along;
    if (found.edge_curvature > 0) nearest.edged = &shape_;
    return true;
  }

  const btPolyhedralConvexShape* polyhedron() const override { return &hull_; }

  const btPolyhedralConvexShape& hull_;
};

}  // namespace

std::unique_ptr<ShapeSurface> makeSphereSurface(const btCollisionShape& shape) {
  return std::make_unique<SphereSurface>(shape);
}

std::unique_ptr<ShapeSurface> makeCapsuleSurface(const btCollisionShape& shape) {
  return std::make_unique<CapsuleSurface>(shape);
}

std::unique_ptr<ShapeSurface> makeCylinderSurface(const btCollisionShape& shape) {
  return std::make_unique<CylinderSurface>(shape);
}

std::unique_ptr<ShapeSurface> makeConeSurface(const btCollisionShape& shape) {
  return std::make_unique<ConeSurface>(shape);
}

std::unique_ptr<ShapeSurface> makeBoxSurface(const btCollisionShape& shape) {
  return std::make_unique<BoxSurface>(shape);
}

std::unique_ptr<ShapeSurface> makeMultiSphereSurface(const btCollisionShape& shape) {
  return std::make_unique<MultiSphereSurface>(static_cast<const btMultiSphereShape&>(shape));
}

std::unique_ptr<ShapeSurface> makeConvexSurface(const btCollisionShape& shape) {
  const auto* const hull = dynamic_cast<const btPolyhedralConvexShape*>(&shape);
  if (hull != nullptr) return std::make_unique<HullSurface>(*hull);
  return std::make_unique<ConvexSurface>(shape);
}

}  // namespace INNERSPHERE_BULLET_PRECISION
}  // namespace innersphere

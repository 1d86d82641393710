#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "innersphere/packing.hpp"

namespace innersphere::test {

namespace {

constexpr Real kPi = 3.141592653589793238462643383279502884L;

struct Ball {
  Vec3l c;  // relative to the origin of its body, world axes
  Real r;
};

std::vector<Ball> balls(const CollisionModel& model, const Placement& placement, std::uint32_t prefix,
                        Estimator estimator, Real margin) {
  const Packing& packing = model.packing();
  std::size_t n = packing.spheres.size();
  if (prefix != 0 && prefix < n) n = prefix;
  const std::vector<float>* radii = nullptr;
  if (estimator == Estimator::volume_true) {
    std::size_t best = 0;
    for (const VolumeTrueRadii& v : packing.volume_true) {
      if (v.count <= n && v.count > best) best = v.count, radii = &v.radii;
    }
    if (radii) n = best;
  }
  std::vector<Ball> result;
  for (std::size_t i = 0; i < n; ++i) {
    const Sphere& s = packing.spheres[i];
    const Real p[3] = {s.x, s.y, s.z};
    Ball ball{};
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 3; ++col)
        ball.c[row] += static_cast<Real>(placement.rotation[3 * row + col]) * p[col];
      ball.c[row] *= placement.scale;
    }
    ball.r = static_cast<Real>(radii ? (*radii)[i] : s.radius) * placement.scale + margin;
    result.push_back(ball);
  }
  return result;
}

Real length(const Vec3l& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Vec3l cross(const Vec3l& a, const Vec3l& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

void addTo(Vec3l& sum, const Vec3l& v, Real factor = 1) {
  for (int i = 0; i < 3; ++i) sum[i] += factor * v[i];
}

/// Textbook formulas: the lens as two caps, cut where the radical plane is.
struct TextbookLens {
  Real volume, from_a, rim_area, energy;  // from_a: distance of the centroid from the centre of a, towards b
};

TextbookLens textbookLens(Real ra, Real rb, Real d) {
  const Real R = ra + rb, D = std::fabs(ra - rb), small = std::min(ra, rb);
  const auto energy = [&](Real x) {
    return kPi / 48 *
           (R * R * R * R - x * x * x * x + 12 * (ra * ra + rb * rb) * (x * x - R * R) +
            32 * (ra * ra * ra + rb * rb * rb) * (R - x) +
            (D > 0 ? 12 * D * D * R * R * std::log(x / R) : 0));
  };
  if (d <= D) {
    const Real volume = 4 * kPi / 3 * small * small * small;
    return {volume, ra > rb ? d : ra < rb ? 0 : d / 2, 0, energy(D) + volume * (D - d)};
  }
  const Real x = (d * d + ra * ra - rb * rb) / (2 * d);  // radical plane
  const Real ha = ra - x, hb = rb - (d - x);
  const Real va = kPi * ha * ha * (3 * ra - ha) / 3, vb = kPi * hb * hb * (3 * rb - hb) / 3;
  // Centroid of a cap of height h: 3 (2r - h)^2 / (4 (3r - h)) from the centre of its ball.
  const Real ca = 3 * (2 * ra - ha) * (2 * ra - ha) / (4 * (3 * ra - ha));
  const Real cb = d - 3 * (2 * rb - hb) * (2 * rb - hb) / (4 * (3 * rb - hb));
  return {va + vb, (va * ca + vb * cb) / (va + vb), kPi * (ra * ra - x * x), energy(d)};
}

}  // namespace

Oracle bruteForce(const PairQuery& query, Estimator estimator) {
  const auto as = balls(*query.a, query.placement_a, query.prefix_a, estimator, query.margin);
  const auto bs = balls(*query.b, query.placement_b, query.prefix_b, estimator, 0);
  Vec3l offset;
  Real size = 0;
  for (int i = 0; i < 3; ++i) {
    offset[i] = static_cast<Real>(query.placement_b.translation[i]) - query.placement_a.translation[i];
    size = std::max(size, std::fabs(offset[i]));
  }
  Oracle oracle;
  oracle.contacts_a.resize(as.size());
  oracle.contacts_b.resize(bs.size());
  for (std::uint32_t i = 0; i < as.size(); ++i) {
    const Ball& a = as[i];
    for (std::uint32_t j = 0; j < bs.size(); ++j) {
      const Ball& b = bs[j];
      Vec3l v = b.c;
      addTo(v, a.c, -1);
      addTo(v, offset);
      const Real d = length(v), sum = a.r + b.r;
      const Real rounding = 4e-15L * (size + length(a.c) + length(b.c) + sum);
      if (d > sum + rounding) continue;
      if (d > sum - rounding) {
        oracle.unclear.push_back({i, j});
        continue;
      }
      oracle.pairs.push_back({i, j});
      const TextbookLens lens = textbookLens(a.r, b.r, d);
      Vec3l n{};
      if (d > 0) addTo(n, v, 1 / d);
      Vec3l centroid = a.c;
      addTo(centroid, n, lens.from_a);
      Vec3l force{};
      addTo(force, n, lens.volume);
      const Vec3l torque = cross(b.c, force);
      oracle.volume += lens.volume;
      oracle.stiffness += lens.rim_area;
      oracle.energy += lens.energy;
      oracle.energy_rounding += 1e-17L * sum * sum * sum * sum;
      addTo(oracle.moment, centroid, lens.volume);
      addTo(oracle.force, force);
      addTo(oracle.torque, torque);
      addTo(oracle.area, n, lens.rim_area);
      oracle.moment_size += lens.volume * (length(a.c) + d);
      oracle.torque_size += length(b.c) * lens.volume;
      for (OracleContact* contact : {&oracle.contacts_a[i], &oracle.contacts_b[j]}) {
        contact->volume += lens.volume;
        addTo(contact->moment, centroid, lens.volume);
        addTo(contact->area, n, lens.rim_area);
        contact->area_size += lens.rim_area;
      }
    }
  }
  return oracle;
}

std::string differenceInPairs(const Oracle& oracle, const SpherePair* pairs, std::size_t count) {
  std::ostringstream out;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
  for (std::size_t k = 0; k < count; ++k) found.push_back({pairs[k].a, pairs[k].b});
  if (!std::is_sorted(found.begin(), found.end())) return "pairs are not sorted";
  if (std::adjacent_find(found.begin(), found.end()) != found.end()) return "a pair is there twice";
  for (const auto& p : oracle.pairs) {
    if (!std::binary_search(found.begin(), found.end(), p)) {
      out << "pair " << p.first << ", " << p.second << " is missing";
      return out.str();
    }
  }
  for (const auto& p : found) {
    if (!std::binary_search(oracle.pairs.begin(), oracle.pairs.end(), p) &&
        !std::binary_search(oracle.unclear.begin(), oracle.unclear.end(), p)) {
      out << "pair " << p.first << ", " << p.second << " does not overlap";
      return out.str();
    }
  }
  return {};
}

std::string differenceInSums(const Oracle& oracle, const Overlap& overlap, double tolerance) {
  std::ostringstream out;
  out.precision(17);
  const auto check = [&](const char* name, Real expected, Real actual, Real scale) {
    if (!(std::fabs(expected - actual) <= tolerance * scale)) {
      out << name << ": expected " << expected << ", is " << actual << " (size of the terms " << scale
          << "); ";
    }
  };
  const auto checkAll = [&](const char* name, const Vec3l& expected, const Vec3d& actual, Real scale) {
    for (int i = 0; i < 3; ++i) check(name, expected[i], actual[i], scale);
  };
  check("volume", oracle.volume, overlap.volume, oracle.volume);
  check("stiffness", oracle.stiffness, overlap.stiffness, oracle.stiffness);
  check("energy", oracle.energy, overlap.energy, oracle.energy + oracle.energy_rounding / tolerance);
  checkAll("force", oracle.force, overlap.force, oracle.volume);
  checkAll("torque", oracle.torque, overlap.torque, oracle.torque_size);
  checkAll("area", oracle.area, overlap.area, oracle.stiffness);
  if (oracle.volume > 0) {
    Vec3d moment;
    for (int i = 0; i < 3; ++i) moment[i] = overlap.centroid[i] * overlap.volume;
    checkAll("centroid times volume", oracle.moment, moment, oracle.moment_size);
  } else {
    checkAll("centroid", {0, 0, 0}, overlap.centroid, 0);
  }
  const std::size_t least = oracle.pairs.size(), most = least + oracle.unclear.size();
  if (overlap.pair_count < least || overlap.pair_count > most) {
    out << "pair_count: expected " << least << " to " << most << ", is " << overlap.pair_count;
  }
  return out.str();
}

}  // namespace innersphere::test

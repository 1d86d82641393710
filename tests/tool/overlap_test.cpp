// The overlap table, against closed forms and against brute force over the exported spheres.
#include <array>
#include <cmath>
#include <sstream>

#include "meshes.hpp"
#include "tool_runner.hpp"

namespace innersphere::test {
namespace {

using Real = long double;
using Vector = std::array<Real, 3>;

const std::string kHeader = "pose,m00,m01,m02,m03,m10,m11,m12,m13,m20,m21,m22,m23\n";

struct Row {
  std::string pose;
  double volume;
  Vector centroid, force, torque;
  double stiffness;
  long pairs;
  double error, error_bound;
};

std::vector<Row> readTable(const std::string& text) {
  const auto rows = readCsv(text);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "pose,volume,cx,cy,cz,fx,fy,fz,tx,ty,tz,stiffness,pairs,error,error_bound");
  std::vector<Row> table;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].size(), 15u);
    const auto number = [&](int column) { return std::stod(rows[i][static_cast<std::size_t>(column)]); };
    const auto vector = [&](int column) {
      return Vector{number(column), number(column + 1), number(column + 2)};
    };
    table.push_back({rows[i][0], number(1), vector(2), vector(5), vector(8), number(11),
                     std::lround(number(12)), number(13), number(14)});
  }
  return table;
}

class Overlap : public ToolTest {};

TEST_F(Overlap, VolumeTrueMeetsTheCylinder) {
  succeed("pack cylinder --spheres 1000 -o cylinder.cbor");
  // Shifted along its axis, and turned about it so that the two packings are not the same sphere by sphere.
  writeFile(path("poses.csv"), "# a comment\n" + kHeader + "half,0.6,-0.8,0,0,0.8,0.6,0,0,0,0,1,0.5\n" +
                                   "quarter,0.6,-0.8,0,0,0.8,0.6,0,0,0,0,1,0.75\n" +
                                   "apart,0.6,-0.8,0,0,0.8,0.6,0,0,0,0,1,1.5\n");
  succeed("overlap cylinder.cbor cylinder.cbor --poses poses.csv -o out.csv");
  const auto table = readTable(readFile(path("out.csv")));
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0].pose, "half");
  const double area = M_PI * 0.3 * 0.3;
  const double shares[2] = {0.5, 0.25};
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(table[i].volume / (shares[i] * area), 1, 0.04);
    EXPECT_NEAR(static_cast<double>(table[i].centroid[2]), 0.5 - shares[i] / 2, 0.02);
    // The gradient of the volume is the area of the contact face, and pushes B along the axis.
    EXPECT_NEAR(static_cast<double>(table[i].force[2]) / area, 1, 0.2);
    EXPECT_NEAR(static_cast<double>(table[i].force[0]) / area, 0, 0.1);
    EXPECT_NEAR(static_cast<double>(table[i].force[1]) / area, 0, 0.1);
  }
  EXPECT_EQ(table[2].volume, 0);
  EXPECT_EQ(table[2].pairs, 0);
  EXPECT_GT(table[0].error_bound, table[0].error);
  EXPECT_GT(table[0].error, 1e-4);
  EXPECT_LT(table[0].error, 0.1);
  EXPECT_TRUE(std::isnan(table[2].error) && std::isnan(table[2].error_bound));
}

// The sums of the paper over all pairs of spheres, B's centres moved by `place`, the torque about
// `reference`.
Row bruteForce(const std::string& xyzr, const std::array<Real, 12>& m, const Vector& reference) {
  std::vector<std::array<Real, 4>> spheres;
  std::stringstream stream(xyzr);
  for (std::string line; std::getline(stream, line);) {
    std::stringstream numbers(line);
    double x, y, z, r;
    if (numbers >> x >> y >> z >> r) spheres.push_back({x, y, z, r});
  }
  EXPECT_GT(spheres.size(), 10u);
  const Real pi = std::acos(Real(-1));
  Row sum{"", 0, {}, {}, {}, 0, 0};
  Real volume = 0, stiffness = 0;
  for (const auto& a : spheres) {
    for (const auto& b : spheres) {
      Vector centre, n;
      for (int i = 0; i < 3; ++i)
        centre[i] = m[4 * i] * b[0] + m[4 * i + 1] * b[1] + m[4 * i + 2] * b[2] + m[4 * i + 3];
      for (int i = 0; i < 3; ++i) n[i] = centre[i] - a[i];
      const Real r1 = a[3], r2 = b[3];
      const Real d = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      if (d >= r1 + r2) continue;
      ++sum.pairs;
      for (Real& x : n) x /= d;
      Real v,
          rim = 0,
          along;  // volume, squared radius of the rim, place of the lens' centroid on the line from a to b
      if (d <= std::abs(r1 - r2)) {
        v = 4 * pi / 3 * std::pow(std::min(r1, r2), 3);
        along = r1 < r2 ? 0 : d;
      } else {
        // Caps of heights h1 and h2; a cap's centroid is 3 (2r - h)^2 / (4 (3r - h)) from its sphere's
        // centre.
        const Real x = (d * d + r1 * r1 - r2 * r2) / (2 * d);
        const Real h1 = r1 - x, h2 = r2 - (d - x);
        const Real v1 = pi * h1 * h1 * (3 * r1 - h1) / 3, v2 = pi * h2 * h2 * (3 * r2 - h2) / 3;
        const Real c1 = 3 * (2 * r1 - h1) * (2 * r1 - h1) / (4 * (3 * r1 - h1));
        const Real c2 = d - 3 * (2 * r2 - h2) * (2 * r2 - h2) / (4 * (3 * r2 - h2));
        v = v1 + v2;
        rim = r1 * r1 - x * x;
        along = (v1 * c1 + v2 * c2) / v;
      }
      Vector arm;
      for (int i = 0; i < 3; ++i) {
        const Real point = a[i] + along * n[i];
        sum.centroid[i] += v * point;
        sum.force[i] += v * n[i];
        arm[i] = point - reference[i];
      }
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sum.torque[i] += v * (arm[j] * n[k] - arm[k] * n[j]);
      }
      volume += v;
      stiffness += pi * rim;
    }
  }
  for (Real& x : sum.centroid) x /= volume;
  sum.volume = static_cast<double>(volume);
  sum.stiffness = static_cast<double>(stiffness);
  return sum;
}

TEST_F(Overlap, RawMeetsBruteForce) {
  writeFile(path("tetra.obj"), kTetrahedron);
  succeed("pack tetra.obj --spheres 200 -o tetra.cbor");
  succeed("convert tetra.cbor tetra.xyzr");
  // A turn by 0.6 and 0.8 (exact) and a shift.
  writeFile(path("poses.csv"), kHeader + "7,0.6,-0.8,0,0.5,0.8,0.6,0,-0.125,0,0,1,0.0625\n");
  succeed("overlap tetra.cbor tetra.cbor --estimator raw --poses poses.csv -o out.csv");
  const auto table = readTable(readFile(path("out.csv")));
  ASSERT_EQ(table.size(), 1u);
  EXPECT_EQ(table[0].pose, "7");

  // The centre of the box around the mesh, (0.5, 0.5, 0.5), goes to (0.4, 0.575, 0.5625).
  const std::array<Real, 12> m{0.6L, -0.8L, 0, 0.5L, 0.8L, 0.6L, 0, -0.125L, 0, 0, 1, 0.0625L};
  const Row expected = bruteForce(readFile(path("tetra.xyzr")), m, {0.4L, 0.575L, 0.5625L});
  EXPECT_EQ(table[0].pairs, expected.pairs);
  EXPECT_NEAR(table[0].volume / expected.volume, 1, 1e-4);
  EXPECT_NEAR(table[0].stiffness / expected.stiffness, 1, 1e-4);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(static_cast<double>(table[0].centroid[i]), static_cast<double>(expected.centroid[i]), 1e-5);
    EXPECT_NEAR(static_cast<double>(table[0].force[i] - expected.force[i]) / expected.volume, 0, 1e-4);
    EXPECT_NEAR(static_cast<double>(table[0].torque[i] - expected.torque[i]) / expected.volume, 0, 1e-4);
  }
}

// A tetrahedron 100,000 of its sizes away, at a place that single precision can hold, and the same pose.
TEST_F(Overlap, FarFromTheOriginItIsTheSame) {
  const std::array<double, 3> place{65536, -131072, 98304};
  std::string far;
  for (const std::array<double, 3>& v : {std::array<double, 3>{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
    far += "v " + std::to_string(place[0] + v[0]) + ' ' + std::to_string(place[1] + v[1]) + ' ' +
           std::to_string(place[2] + v[2]) + '\n';
  }
  writeFile(path("near.obj"), kTetrahedron);
  writeFile(path("far.obj"), far + kTetrahedron.substr(kTetrahedron.find("f ")));
  succeed("pack near.obj --spheres 200 -o near.cbor");
  const Outcome packed = run("pack far.obj --spheres 200 -o far.cbor");
  EXPECT_EQ(packed.exit_code, 0);
  EXPECT_NE(packed.err.find("single precision"), std::string::npos) << packed.err;
  EXPECT_EQ(run("check far.cbor --mesh far.obj").exit_code, 0);

  // x -> R x + t becomes x -> R (x - place) + place + t.
  const double c = 0.6, s = 0.8;
  const std::array<double, 3> turned{c * place[0] - s * place[1], s * place[0] + c * place[1], place[2]};
  char row[200];
  std::snprintf(row, sizeof row, "0,0.6,-0.8,0,%.17g,0.8,0.6,0,%.17g,0,0,1,%.17g\n",
                0.5 + place[0] - turned[0], -0.125 + place[1] - turned[1], 0.0625);
  writeFile(path("near.csv"), kHeader + "0,0.6,-0.8,0,0.5,0.8,0.6,0,-0.125,0,0,1,0.0625\n");
  writeFile(path("far.csv"), kHeader + row);
  for (const char* estimator : {"raw", "volume-true", "surface"}) {
    const std::string options = std::string(" --force --estimator ") + estimator;
    succeed("overlap near.cbor near.cbor --poses near.csv -o near_out.csv" + options);
    succeed("overlap far.cbor far.cbor --poses far.csv -o far_out.csv" + options);
    const Row near = readTable(readFile(path("near_out.csv")))[0];
    const Row there = readTable(readFile(path("far_out.csv")))[0];
    EXPECT_NEAR(there.volume / near.volume, 1, 1e-4);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(static_cast<double>(there.centroid[i] - near.centroid[i]), place[i], 1e-4);
      EXPECT_NEAR(static_cast<double>(there.force[i] / near.force[i]), 1, 1e-3);
      EXPECT_NEAR(static_cast<double>(there.torque[i] - near.torque[i]) / near.volume, 0, 1e-3);
    }
  }
}

// The second shell reaches into the first one: a corner of both is enclosed twice.
TEST_F(Overlap, TrianglesThatCountTwiceAreNoted) {
  writeFile(path("one.obj"), kTetrahedron);
  writeFile(path("two.obj"), kTetrahedron +
                                 "v .1 .1 .1\nv 1.1 .1 .1\nv .1 1.1 .1\nv .1 .1 1.1\nf 5 7 6\nf 5 6 8\n"
                                 "f 5 8 7\nf 6 7 8\n");
  run("pack one.obj --spheres 64 -o one.cbor");
  run("pack two.obj --spheres 64 -o two.cbor");
  writeFile(path("poses.csv"), kHeader + "0,1,0,0,0.1,0,1,0,0.1,0,0,1,0\n");
  const std::string rest = " --poses poses.csv --estimator surface --force -o out.csv";
  succeed("overlap one.cbor one.cbor" + rest);
  EXPECT_EQ(readTable(readFile(path("out.csv")))[0].error, 0);
  const Outcome noted = run("overlap one.cbor two.cbor" + rest);
  EXPECT_EQ(noted.exit_code, 0);
  EXPECT_NE(noted.err.find("two.cbor"), std::string::npos) << noted.err;
  EXPECT_EQ(noted.err.find("one.cbor"), std::string::npos) << noted.err;
  EXPECT_TRUE(std::isnan(readTable(readFile(path("out.csv")))[0].error));
}

TEST_F(Overlap, TablesMayHaveAByteOrderMark) {
  writeFile(path("ball.xyzr"), "0 0 0 1\n");
  // Two equal balls at a distance of one radius share 5/16 of their volume.
  const std::string rows = kHeader + "near,1,0,0,1,0,1,0,0,0,0,1,0\n";
  writeFile(path("marked.csv"), "\xef\xbb\xbf" + rows);
  const std::string out = succeed("overlap ball.xyzr ball.xyzr --estimator raw --poses marked.csv -o -").out;
  EXPECT_EQ(out.find("-nan"), std::string::npos) << "what is not known has no sign: " << out;
  const auto table = readTable(out);
  ASSERT_EQ(table.size(), 1u);
  EXPECT_EQ(table[0].pose, "near");
  EXPECT_NEAR(table[0].volume, 5.0 / 16 * 4 * M_PI / 3, 1e-5);
}

TEST_F(Overlap, FewerSpheresAreThePrefix) {
  succeed("pack box --spheres 200 -o box.cbor");
  writeFile(path("poses.csv"), kHeader + "0,1,0,0,0.3,0,1,0,0.1,0,0,1,0\n");
  succeed("overlap box.cbor box.cbor --poses poses.csv --spheres 64 -o few.csv");
  succeed("overlap box.cbor box.cbor --poses poses.csv -o all.csv");
  EXPECT_LT(readTable(readFile(path("few.csv")))[0].pairs, readTable(readFile(path("all.csv")))[0].pairs);
  const Outcome outcome = run("overlap box.cbor box.cbor --poses poses.csv --spheres 500 -o more.csv");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "box.cbor has only 200 spheres: all of them are used\n");
  EXPECT_EQ(readFile(path("more.csv")), readFile(path("all.csv")));
  // Of two packings each is named.
  succeed("pack ball -o ball.cbor");
  EXPECT_EQ(run("overlap box.cbor ball.cbor --poses poses.csv --spheres 500 -o both.csv").err,
            "box.cbor has only 200 spheres: all of them are used\n"
            "ball.cbor has only one sphere\n");
}

TEST_F(Overlap, DevicesAreNamed) {
  succeed("pack box --spheres 64 -o box.cbor");
  writeFile(path("poses.csv"), kHeader + "0,1,0,0,0.3,0,1,0,0.1,0,0,1,0\n");
  const std::string command = "overlap box.cbor box.cbor --poses poses.csv -o out.csv --force --device ";
  for (const char* device : {"-1", "first", "1x"}) refuse(command + device, 2, {"--device", device});
  succeed(command + "all --backend cpu");  // a device that nobody asks need not be there
  EXPECT_NE(run(command + "99 --backend cuda").exit_code, 0);
}

// The shards of a table of 700 rows (more than one batch), for some splits; more shards than rows, too.
TEST_F(Overlap, ShardsMergeToTheSameBytes) {
  succeed("pack torus --spheres 100 -o torus.cbor");
  std::string poses = kHeader;
  for (int i = 0; i < 700; ++i) {
    poses +=
        "p" + std::to_string(i) + ",0.6,-0.8,0," + std::to_string(1e-3 * i) + ",0.8,0.6,0,0.1,0,0,1,0.05\n";
  }
  writeFile(path("poses.csv"), poses);
  const std::string command = "overlap torus.cbor torus.cbor --poses poses.csv -o ";
  succeed(command + "whole.csv");
  const std::string whole = readFile(path("whole.csv"));
  for (const int count : {2, 3, 701}) {
    // As a Slurm array would, but one after the other; the last of three only some.
    std::string parts;
    for (int i = count; i >= 1; --i) {
      const std::string part = "part-" + std::to_string(i) + ".csv";
      if (count < 700 || i % 100 == 1) {
        succeed(command + part + " --force --shard " + std::to_string(i) + "/" + std::to_string(count));
        parts += part + " ";
      }
    }
    if (count > 700) {
      refuse("merge " + parts + "-o many.csv", 3, {"missing", " 2 ", " 700"});
      continue;
    }
    succeed("merge " + parts + "--force -o merged.csv");
    EXPECT_EQ(readFile(path("merged.csv")), whole);
  }
}

TEST_F(Overlap, ShardsThatDoNotFitTogetherAreNamed) {
  writeFile(path("ball.xyzr"), "0 0 0 1\n");
  const std::string row = "1,0,0,0.5,0,1,0,0,0,0,1,0\n";
  writeFile(path("poses.csv"), kHeader + "a," + row + "b," + row + "c," + row);
  writeFile(path("others.csv"), kHeader + "a," + row + "b," + row + "d," + row);
  const auto part = [&](const char* poses, const char* shard, const char* name, const char* options = "") {
    succeed(std::string("overlap ball.xyzr ball.xyzr --poses ") + poses + " --shard " + shard + " -o " +
            name + options);
  };
  part("poses.csv", "1/2", "one.csv");
  part("poses.csv", "2/2", "two.csv");
  part("others.csv", "2/2", "other.csv");
  part("poses.csv", "2/2", "raw.csv", " --estimator raw");
  part("poses.csv", "2/3", "third.csv");
  succeed("overlap ball.xyzr ball.xyzr --poses poses.csv -o whole.csv");
  for (const char* wrong : {"other.csv", "raw.csv", "third.csv"})
    refuse(std::string("merge one.csv ") + wrong + " -o out.csv", 3, {wrong, "different tables"});
  refuse("merge one.csv -o out.csv", 3, {"missing: 2"});
  refuse("merge two.csv -o out.csv", 3, {"missing: 1"});
  refuse("merge one.csv two.csv one.csv -o out.csv", 3, {"one.csv", "twice"});
  refuse("merge one.csv whole.csv -o out.csv", 3, {"whole.csv", "not a shard"});
  refuse("merge one.csv nothing.csv -o out.csv", 3, {"nothing.csv"});
  refuse("merge one.csv two.csv -o whole.csv", 5, {"whole.csv", "--force"});
  const std::string two = readFile(path("two.csv"));
  for (const std::size_t lost : {std::size_t{1}, std::size_t{60}}) {
    writeFile(path("two.csv"), two.substr(0, two.size() - lost));
    refuse("merge one.csv two.csv -o out.csv", 3, {"two.csv", "damaged"});
  }
  writeFile(path("two.csv"), two + two.substr(two.rfind("c,")));
  refuse("merge one.csv two.csv -o out.csv", 3, {"two.csv", "3 whole rows of 2"});
}

}  // namespace
}  // namespace innersphere::test

// Packings on disk: what is written comes back, what is damaged is named, nothing half-written stays.
#include <gtest/gtest.h>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>

#include "file/packing_json.hpp"
#include "file/packing_text.hpp"
#include "file_scratch.hpp"
#include "innersphere/error.hpp"
#include "innersphere/packing_file.hpp"
#include "packer_oracles.hpp"

namespace innersphere::test {
namespace {

Packing somePacking(std::size_t n, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(-3, 3);
  Packing packing;
  for (std::size_t i = 0; i < n; ++i) {
    packing.spheres.push_back(
        {number(random), number(random), number(random), 1 / static_cast<float>(i + 3)});
  }
  for (std::uint32_t count = 2; count <= n; count *= 2) {
    VolumeTrueRadii radii{count, {}, 0.01 / count};
    for (std::uint32_t i = 0; i < count; ++i) radii.radii.push_back(std::exp(number(random)));
    packing.volume_true.push_back(radii);
  }
  packing.origin = {1e6, 0, -1.0 / 3};
  packing.solid = {1.0 / 3, {0.1, -0.2, 1e-17}, {1, 2, 3, 4, 5, 6, 7, 8, 1e-300}};
  packing.surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.0f / 3}};
  packing.surface.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  packing.certificate = {0.1, 0.00123};
  packing.quality = {0.8, 0.01, 0.02, 0.1 + 0.2};
  packing.coverage = {{2, 0.1, 0.2, 1.0 / 3, {1, -2, 1e-17}, 0.25}, {5, 0.01, 0.02, 0.03, {}, 0}};
  packing.overlap_errors = {
      200,
      1e-5,
      1.0 / 3,
      {{2,
        {{{1e-3, {0.5, 1.0 / 3}, 1.0 / 7, 1.0 / 9}, {0.1, {0.4, 0.6}}}, 0.1 + 0.2, {}, {}, {}},
        {{},
         0,
         {{0.2, {1e-17, 0.7}, 1e-9, 0.5}},
         {{0.7, {0.1, 0.3}, 0.7, -1.5}},
         {{0.01, {0.2, 0.4}, 0.01, 0.5}, {0.04, {0.1, 0.2}, 0.04, 0.5}}}}}};
  for (std::size_t i = 0; i < n; ++i) packing.mass_weights.push_back(1 + 1 / static_cast<float>(i + 3));
  packing.warnings = {"a \"part\" is empty", ""};
  packing.provenance = {"some \"mesh\".obj", "0123456789abcdef", "--spheres 5", "0.1.0"};
  return packing;
}

void expectSame(const Packing& a, const Packing& b) {
  ASSERT_EQ(a.spheres.size(), b.spheres.size());
  for (std::size_t i = 0; i < a.spheres.size(); ++i) {
    EXPECT_EQ(a.spheres[i].x, b.spheres[i].x);
    EXPECT_EQ(a.spheres[i].y, b.spheres[i].y);
    EXPECT_EQ(a.spheres[i].z, b.spheres[i].z);
    EXPECT_EQ(a.spheres[i].radius, b.spheres[i].radius);
  }
  ASSERT_EQ(a.volume_true.size(), b.volume_true.size());
  for (std::size_t i = 0; i < a.volume_true.size(); ++i) {
    EXPECT_EQ(a.volume_true[i].count, b.volume_true[i].count);
    EXPECT_EQ(a.volume_true[i].radii, b.volume_true[i].radii);
    EXPECT_EQ(a.volume_true[i].sampling_error, b.volume_true[i].sampling_error);
  }
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.solid.volume, b.solid.volume);
  EXPECT_EQ(a.solid.centre_of_mass, b.solid.centre_of_mass);
  EXPECT_EQ(a.solid.inertia, b.solid.inertia);
  EXPECT_EQ(a.surface.vertices, b.surface.vertices);
  EXPECT_EQ(a.surface.triangles, b.surface.triangles);
  EXPECT_EQ(a.certificate.delta, b.certificate.delta);
  EXPECT_EQ(a.certificate.largest_missing_radius, b.certificate.largest_missing_radius);
  EXPECT_EQ(a.quality.density, b.quality.density);
  EXPECT_EQ(a.quality.gap_mean, b.quality.gap_mean);
  EXPECT_EQ(a.quality.gap_p95, b.quality.gap_p95);
  EXPECT_EQ(a.quality.gap_max, b.quality.gap_max);
  EXPECT_EQ(a.order, b.order);
  ASSERT_EQ(a.coverage.size(), b.coverage.size());
  for (std::size_t i = 0; i < a.coverage.size(); ++i) {
    const Coverage &c = a.coverage[i], &d = b.coverage[i];
    EXPECT_EQ(std::tie(c.count, c.mean, c.p95, c.max, c.farthest, c.uncovered),
              std::tie(d.count, d.mean, d.p95, d.max, d.farthest, d.uncovered));
  }
  EXPECT_EQ(a.mass_weights, b.mass_weights);
  EXPECT_EQ(a.warnings, b.warnings);
  EXPECT_EQ(a.overlap_errors.poses, b.overlap_errors.poses);
  EXPECT_EQ(a.overlap_errors.shallowest, b.overlap_errors.shallowest);
  EXPECT_EQ(a.overlap_errors.sampling_error, b.overlap_errors.sampling_error);
  ASSERT_EQ(a.overlap_errors.prefixes.size(), b.overlap_errors.prefixes.size());
  for (std::size_t i = 0; i < a.overlap_errors.prefixes.size(); ++i) {
    EXPECT_EQ(a.overlap_errors.prefixes[i].count, b.overlap_errors.prefixes[i].count);
    const OverlapErrors::Prefix &one = a.overlap_errors.prefixes[i], &other = b.overlap_errors.prefixes[i];
    EXPECT_TRUE(sameEstimate(one.raw, other.raw));
    EXPECT_TRUE(sameEstimate(one.volume_true, other.volume_true));
  }
  EXPECT_EQ(a.provenance.source, b.provenance.source);
  EXPECT_EQ(a.provenance.source_hash, b.provenance.source_hash);
  EXPECT_EQ(a.provenance.options, b.provenance.options);
  EXPECT_EQ(a.provenance.version, b.provenance.version);
}

template <class Action>
void expectError(ErrorCode code, const std::string& hint, const Action& action) {
  try {
    action();
    ADD_FAILURE() << "no error where " << toString(code) << " was expected";
  } catch (const Error& error) {
    EXPECT_STREQ(toString(error.code()), toString(code)) << error.what();
    EXPECT_NE(std::string(error.what()).find(hint), std::string::npos) << error.what();
  }
}

TEST(FilePacking, JsonAndCborGiveTheSameBitsBack) {
  const Scratch scratch;
  Packing packing = somePacking(500);
  packing.spheres.back() = {1e-40f, -0.0f, 16777217.0f, 1e-45f};  // denormal, signed zero, large
  for (const char* name : {"p.json", "p.cbor", "p.JSON"}) {
    writePacking(packing, scratch.path(name));
    expectSame(readPacking(scratch.path(name)), packing);
  }
  EXPECT_EQ(scratch.files(), 3u);
}

TEST(FilePacking, BytesInMemoryAreThoseOfAFile) {
  const Packing packing = somePacking(20);
  const std::string bytes = encodePacking(packing);
  expectSame(decodePacking(bytes), packing);
  const std::string path = testing::TempDir() + "/encoded.cbor";
  writePacking(packing, path, true);
  std::ifstream file(path, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), bytes);
  for (const std::string& damaged : {std::string(), bytes.substr(0, bytes.size() / 2), "x" + bytes}) {
    try {
      decodePacking(damaged);
      ADD_FAILURE() << "damaged bytes were accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_format) << error.what();
    }
  }
  EXPECT_THROW(encodePacking(Packing()), Error);
}

// Wherever that is: in a number, a text, a key.
TEST(FilePacking, FilesThatEndEarlyAreSaidToDoSo) {
  const Scratch scratch;
  const Packing packing = somePacking(3);
  const std::pair<std::string, Packing (*)(const std::string&)> readers[] = {{toJson(packing), fromJson},
                                                                             {toCbor(packing), fromCbor}};
  for (const auto& [bytes, read] : readers) {
    for (std::size_t size = 0; size <= bytes.find_last_not_of('\n'); ++size) {
      expectError(ErrorCode::bad_format,
                  "it ends early, after " + std::to_string(size) + " bytes; the file is damaged",
                  [&, read = read] { read(bytes.substr(0, size)); });
    }
    // More than there should be is another matter.
    expectError(ErrorCode::bad_format, "parse error at ", [&, read = read] { read(bytes + "}"); });
  }
  const std::string path = scratch.write("p.cbor", toCbor(packing).substr(0, 100));
  expectError(ErrorCode::bad_format, path + ": it ends early", [&] { readPacking(path); });
}

// CBOR can hold numbers that JSON cannot: what is read from the one has to go into the other.
TEST(FilePacking, NoNumberOfAFileMayBeOutOfAllNumbers) {
  const nlohmann::json document = nlohmann::json::from_cbor(toCbor(somePacking(3))),
                       flat = document.flatten();
  int numbers = 0;
  for (const auto& [path, value] : flat.items()) {
    if (!value.is_number_float()) continue;
    ++numbers;
    nlohmann::json damaged = document;
    damaged[nlohmann::json::json_pointer(path)] = std::nan("");
    std::string bytes;
    nlohmann::json::to_cbor(damaged, bytes);
    expectError(ErrorCode::not_finite, "is not finite", [&] { decodePacking(bytes); });
    if (HasFailure()) FAIL() << path;
  }
  EXPECT_GT(numbers, 50);
}

TEST(FilePacking, EmptySurfaceAndPrefixesAreFine) {
  const Scratch scratch;
  Packing packing = somePacking(3);
  packing.surface = {};
  packing.volume_true.clear();
  for (const char* name : {"p.json", "p.cbor"}) {
    writePacking(packing, scratch.path(name));
    expectSame(readPacking(scratch.path(name)), packing);
  }
}

// As the first files were.
TEST(FilePacking, FilesWithoutTheLaterEntriesAreFine) {
  Packing packing = somePacking(3);
  nlohmann::json document = nlohmann::json::parse(toJson(packing));
  for (const char* key : {"origin", "order", "coverage", "errors_by_depth", "mass_weights", "warnings"}) {
    EXPECT_EQ(document.erase(key), 1u);
  }
  document["version"] = 1;
  packing.origin = {};
  packing.coverage = {};
  packing.overlap_errors = {};
  packing.mass_weights.clear();
  packing.warnings.clear();
  expectSame(fromJson(document.dump()), packing);
}

// Files of before planes were measured keep what they have.
TEST(FilePacking, EstimatesWithoutPlanesAreRead) {
  const Packing packing = somePacking(3);
  nlohmann::json document = nlohmann::json::parse(toJson(packing));
  nlohmann::json& prefix = document["errors_by_depth"]["prefixes"][0];
  EXPECT_EQ(prefix.erase("raw_planes") + prefix.erase("volume_true_planes"), 2u);
  const Packing read = fromJson(document.dump());
  EXPECT_EQ(read.warnings, packing.warnings);
  const OverlapErrors::Estimate &raw = read.overlap_errors.prefixes.at(0).raw,
                                &had = packing.overlap_errors.prefixes.at(0).raw;
  EXPECT_TRUE(sameErrors(raw.copies, had.copies));
  EXPECT_TRUE(raw.planes.empty());
  EXPECT_EQ(expectedError(raw, 0.1, 7).mean, expectedError(had, 0.1).mean);
}

// Of copies that lie nearly upon the solid they know nothing.
TEST(FilePacking, EstimatesWithoutDeepCopiesAreRead) {
  const Packing packing = somePacking(3);
  nlohmann::json document = nlohmann::json::parse(toJson(packing));
  EXPECT_EQ(document["errors_by_depth"]["prefixes"][0].erase("volume_true_deep"), 1u);
  const OverlapErrors::Estimate known = packing.overlap_errors.prefixes.at(0).volume_true,
                                read = fromJson(document.dump()).overlap_errors.prefixes.at(0).volume_true;
  EXPECT_TRUE(sameErrors(read.planes, known.planes));
  EXPECT_TRUE(std::isnan(expectedError(read, 0.5, 0, 0.7, 0.7).bound));
  EXPECT_EQ(expectedError(known, 0.5, 0, 0.7, 0.7).bound, 0.3);
  EXPECT_EQ(expectedError(read, 0.5, 0, 0.7, 0.4).bound, expectedError(known, 0.5, 0, 0.7, 0.4).bound);
}

// Of balls inside they know nothing: copies and planes are all there is. Where balls are known, no less is
// foretold than for a ball as large: between two of them, and beyond by the root of the volume.
TEST(FilePacking, EstimatesWithoutBallsInsideAreRead) {
  Packing packing = somePacking(3);
  OverlapErrors::Estimate& known = packing.overlap_errors.prefixes.at(0).volume_true;
  known.copies = {{0.1, {0.03, 0.15}, 0.1, 0}};
  nlohmann::json document = nlohmann::json::parse(toJson(packing));
  EXPECT_EQ(document["errors_by_depth"]["prefixes"][0].erase("volume_true_inside"), 1u);
  const OverlapErrors::Estimate read = fromJson(document.dump()).overlap_errors.prefixes.at(0).volume_true;
  for (const double volume : {0.02, 0.16, 0.4}) {
    EXPECT_EQ(expectedError(read, 0.1, 0, volume).mean, 0.03);
    EXPECT_EQ(expectedError(read, 0.1, 0, volume).bound, 0.15);
  }
  EXPECT_EQ(expectedError(known, 0.1).mean, 0.03);
  EXPECT_NEAR(expectedError(known, 0.1, 0, 0.02).mean, std::sqrt(0.2 * 0.1), 1e-9);
  EXPECT_NEAR(expectedError(known, 0.1, 0, 0.02).bound, std::sqrt(0.4 * 0.2), 1e-9);
  EXPECT_NEAR(expectedError(known, 0.1, 0, 0.16).mean, 0.05, 1e-9);
  EXPECT_EQ(expectedError(known, 0.1, 0, 0.16).bound, 0.15);
  EXPECT_EQ(expectedError(known, 0.1, 0, 0.45).mean, 0.03);
}

// Nor do they know how errors fall with the volume.
TEST(FilePacking, EstimatesWithoutVolumesAreRead) {
  nlohmann::json document = nlohmann::json::parse(toJson(somePacking(3)));
  for (nlohmann::json& row : document["errors_by_depth"]["prefixes"][0]["raw"])
    EXPECT_EQ(row.erase("volume") + row.erase("power"), 2u);
  const OverlapErrors::Estimate raw = fromJson(document.dump()).overlap_errors.prefixes.at(0).raw;
  ASSERT_EQ(raw.copies.size(), 2u);
  EXPECT_EQ(raw.copies[0].power, 0);
  EXPECT_EQ(expectedError(raw, 0.01, 0, 1e-3).mean, expectedError(raw, 0.01).mean);
}

// Their estimates of errors were means of four bins, then relative to the truth, then by volume: they are not
// taken for what is written today.
TEST(FilePacking, OldEstimatesAreLeftOutWithAWord) {
  Packing packing = somePacking(3);
  for (const char* key : {"overlap_errors", "expected_errors", "volume_errors"}) {
    nlohmann::json document = nlohmann::json::parse(toJson(packing));
    document[key] = document["errors_by_depth"];
    document.erase("errors_by_depth");
    const Packing read = fromJson(document.dump());
    EXPECT_TRUE(read.overlap_errors.prefixes.empty());
    ASSERT_EQ(read.warnings.size(), packing.warnings.size() + 1);
    EXPECT_NE(read.warnings.back().find("pack the solid again"), std::string::npos);
  }
}

TEST(FilePacking, BadMeasuresAreRefused) {
  const nlohmann::json good = nlohmann::json::parse(toJson(somePacking(3)));
  const auto refused = [&](const char* pointer, const nlohmann::json& value) {
    nlohmann::json document = good;
    document[nlohmann::json::json_pointer(pointer)] = value;
    try {
      validate(fromJson(document.dump()));
      ADD_FAILURE() << pointer << " " << value;
    } catch (const Error&) {
    }
  };
  refused("/mass_weights", {1.0, 1.0});
  refused("/mass_weights", {1.0, 0.0, 1.0});
  refused("/mass_weights", {1.0, 1e99, 1.0});
  refused("/warnings", {1});
  refused("/warnings", "text");
  refused("/order", "size");
  refused("/coverage", 1);
  refused("/coverage/0/count", -1);
  refused("/coverage/0/farthest", {1, 2});
  refused("/errors_by_depth", 1);
  refused("/errors_by_depth/poses", -4);
  refused("/errors_by_depth/shallowest", "deep");
  refused("/errors_by_depth/sampling_error", nullptr);
  refused("/errors_by_depth/prefixes/0/count", 1.5);
  refused("/errors_by_depth/prefixes/0/raw", {0.1});
  refused("/errors_by_depth/prefixes/0/raw/0/depth", 0.2);
  refused("/errors_by_depth/prefixes/0/raw/0/depth", 0);
  refused("/errors_by_depth/prefixes/0/raw/1/mean", {0.1});
  refused("/errors_by_depth/prefixes/0/raw/0/volume", 0);
  refused("/errors_by_depth/prefixes/0/raw/0/power", "half");
  refused("/errors_by_depth/prefixes/0/volume_true/0/bound", nullptr);
  refused("/errors_by_depth/prefixes/0/raw_planes", 1);
  refused("/errors_by_depth/prefixes/0/raw_planes/thicker_than", "thick");
  refused("/errors_by_depth/prefixes/0/volume_true_inside", 1);
  refused("/errors_by_depth/prefixes/0/volume_true_inside/1/depth", 0.01);
  refused("/errors_by_depth/prefixes/0/volume_true_planes/errors", 1);
  refused("/errors_by_depth/prefixes/0/volume_true_planes/errors/0/depth", -1);
}

TEST(FilePacking, JsonIsReadableByPeople) {
  const Scratch scratch;
  Packing packing = somePacking(1);
  packing.spheres[0] = {0.1f, 0.2f, 0.3f, 0.4f};
  writePacking(packing, scratch.path("p.json"));
  const std::string text = bytesOf(scratch.path("p.json"));
  EXPECT_NE(text.find("\n\"spheres\": [0.1,0.2,0.3,0.4]"), std::string::npos) << text;
}

TEST(FilePacking, PathsThatAreNotUtf8DoNotStopTheWriter) {
  const Scratch scratch;
  Packing packing = somePacking(2);
  packing.provenance.source = "m\xe4sh.obj";
  writePacking(packing, scratch.path("p.json"));
  EXPECT_EQ(readPacking(scratch.path("p.json")).spheres.size(), 2u);
  writePacking(packing, scratch.path("p.cbor"));
  EXPECT_EQ(readPacking(scratch.path("p.cbor")).provenance.source, packing.provenance.source);
}

TEST(FilePacking, XyzrKeepsTheSpheres) {
  const Scratch scratch;
  Packing packing = somePacking(100);
  packing.origin = {};
  writePacking(packing, scratch.path("p.xyzr"));
  const Packing back = readPacking(scratch.path("p.xyzr"));
  ASSERT_EQ(back.spheres.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(back.spheres[i].x, packing.spheres[i].x);
    EXPECT_EQ(back.spheres[i].radius, packing.spheres[i].radius);
  }
  EXPECT_EQ(back.certificate.delta, 0);
}

// Text is in the solid's coordinates, wherever it was.
TEST(FilePacking, XyzrFarFromTheOriginKeepsTheSpheresToo) {
  const Scratch scratch;
  Packing packing = somePacking(100);
  packing.origin = {1e6, 0, -1e9};
  writePacking(packing, scratch.path("p.xyzr"));
  const Packing back = readPacking(scratch.path("p.xyzr"));
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_NEAR(back.origin[0] - 1e6 + back.spheres[i].x, packing.spheres[i].x, 1e-6);
    EXPECT_EQ(back.spheres[i].y, packing.spheres[i].y);
    EXPECT_NEAR(back.origin[2] + 1e9 + back.spheres[i].z, packing.spheres[i].z, 1e-6);
    EXPECT_EQ(back.spheres[i].radius, packing.spheres[i].radius);
  }
}

TEST(FilePacking, XyzrFromOtherProgramsIsSortedAndWeighed) {
  const Scratch scratch;
  const std::string path =
      scratch.write("p.xyzr", "# two balls\n\n-1, 0, 0, 1\r\n 2\t0 0 2 # the large one\n   \n");
  const Packing packing = readPacking(path);
  ASSERT_EQ(packing.spheres.size(), 2u);
  EXPECT_EQ(packing.spheres[0].radius, 2);
  EXPECT_EQ(packing.spheres[1].x, -1);
  const double unit = 4 * M_PI / 3;
  EXPECT_NEAR(packing.solid.volume, 9 * unit, 1e-12);
  EXPECT_NEAR(packing.solid.centre_of_mass[0], (8 * 2 - 1) / 9.0, 1e-14);
  EXPECT_NEAR(packing.solid.inertia[0], unit * 0.4 * (32 + 1), 1e-12);
  const double apart = 3 * 3 * 8.0 / 9;  // reduced mass of 8 and 1, three apart
  EXPECT_NEAR(packing.solid.inertia[4], unit * (0.4 * (32 + 1) + apart), 1e-12);
  EXPECT_NEAR(packing.solid.inertia[1], 0, 1e-12);
  EXPECT_EQ(packing.provenance.source, path);
  EXPECT_TRUE(packing.warnings.empty());
}

TEST(FilePacking, XyzrWhoseSpheresOverlapIsFlagged) {
  const Scratch scratch;
  const Packing packing = readPacking(scratch.write("p.xyzr", "9 0 0 2\n0 0 0 1\n1.5 0 0 0.75\n"));
  ASSERT_EQ(packing.warnings.size(), 1u);
  EXPECT_NE(packing.warnings[0].find("spheres 1 and 2 by 0.25 m"), std::string::npos) << packing.warnings[0];
}

TEST(FilePacking, PlyNamesItsColumns) {
  const Scratch scratch;
  Packing packing = somePacking(7);
  writePacking(packing, scratch.path("far.ply"));
  EXPECT_NE(bytesOf(scratch.path("far.ply")).find("vertex 7\nproperty double x\n"), std::string::npos);
  packing.origin = {};
  writePacking(packing, scratch.path("p.ply"));
  const std::string text = bytesOf(scratch.path("p.ply"));
  EXPECT_EQ(text.rfind("ply\nformat ascii 1.0\n", 0), 0u);
  EXPECT_NE(
      text.find(
          "element vertex 7\nproperty float x\nproperty float y\nproperty float z\nproperty float radius\n"),
      std::string::npos);
  EXPECT_EQ(std::count(text.begin() + text.find("end_header"), text.end(), '\n'), 8);
}

TEST(FilePacking, WritingIsAllOrNothing) {
  const Scratch scratch;
  const std::string path = scratch.write("p.json", "precious");
  expectError(ErrorCode::file_exists, "p.json", [&] { writePacking(somePacking(3), path); });
  EXPECT_EQ(bytesOf(path), "precious");
  writePacking(somePacking(3), path, true);
  EXPECT_EQ(readPacking(path).spheres.size(), 3u);

  expectError(ErrorCode::bad_argument, ".cbor", [&] { writePacking(somePacking(3), scratch.path("p.txt")); });
  expectError(ErrorCode::write_failed, "none",
              [&] { writePacking(somePacking(3), scratch.path("none/p.json")); });
  std::filesystem::create_directory(scratch.path("folder.json"));
  expectError(ErrorCode::write_failed, "folder",
              [&] { writePacking(somePacking(3), scratch.path("folder.json"), true); });
  Packing bad = somePacking(3);
  bad.quality.gap_max = std::nan("");
  expectError(ErrorCode::not_finite, "quality", [&] { writePacking(bad, scratch.path("bad.json")); });
  EXPECT_EQ(scratch.files(), 2u);
}

// A limit on the size of files acts like a disk that is full.
TEST(FilePacking, FullDiskIsAnError) {
  const Scratch scratch;
  const Packing packing = somePacking(20000);
  expectError(ErrorCode::write_failed, "p.json", [&] {
    struct Limit {
      Limit() {
        getrlimit(RLIMIT_FSIZE, &before);
        rlimit small = before;
        small.rlim_cur = 4096;
        setrlimit(RLIMIT_FSIZE, &small);
        handler = std::signal(SIGXFSZ, SIG_IGN);
      }
      ~Limit() {
        setrlimit(RLIMIT_FSIZE, &before);
        std::signal(SIGXFSZ, handler);
      }
      rlimit before{};
      void (*handler)(int) = nullptr;
    } limit;
    writePacking(packing, scratch.path("p.json"));
  });
  EXPECT_EQ(scratch.files(), 0u);
}

TEST(FilePacking, SaysWhatIsWrong) {
  const Scratch scratch;
  const auto expect = [&](const std::string& name, const std::string& bytes, ErrorCode code,
                          const std::string& hint) {
    const std::string path = scratch.write(name, bytes);
    expectError(code, hint, [&] { readPacking(path); });
    expectError(code, name, [&] { readPacking(path); });
  };
  expectError(ErrorCode::file_not_found, "none.json", [&] { readPacking(scratch.path("none.json")); });
  expectError(ErrorCode::file_not_found, "folder", [&] { readPacking(scratch.folder().string()); });
  expect("a.json", "", ErrorCode::bad_format, "ends early");
  expect("a.cbor", "", ErrorCode::bad_format, "ends early");
  expect("b.json", "{}", ErrorCode::bad_format, "not a packing");
  expect("c.json", "[1, 2, 3]", ErrorCode::bad_format, "not a packing");
  expect("d.txt", "1 2 3 4", ErrorCode::bad_format, ".txt");
  expect("a.xyzr", "", ErrorCode::empty_input, "no spheres");
  expect("b.xyzr", "1 2 3 4\n1 2 3\n", ErrorCode::bad_format, "line 2");
  expect("c.xyzr", "1 2 3 4 5\n", ErrorCode::bad_format, "line 1");
  expect("d.xyzr", "1 2 3 r\n", ErrorCode::bad_format, "line 1");
  expect("e.xyzr", "1 2 3 -4\n", ErrorCode::bad_format, "not positive");
  expect("f.xyzr", "1 2 nan 4\n", ErrorCode::not_finite, "sphere 0");
  expect("g.xyzr", "1 2 1e300 4\n", ErrorCode::not_finite, "sphere 0");

  writePacking(somePacking(4), scratch.path("good.json"));
  const std::string good = bytesOf(scratch.path("good.json"));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  expect("1.json", with("\"version\": 2", "\"version\": 3"), ErrorCode::unsupported_version, "version 3");
  expect("2.json", with("\"version\": 2", "\"version\": 1e300"), ErrorCode::unsupported_version, "version");
  expect("3.json", with("\"version\": 2", "\"version\": 0"), ErrorCode::bad_format, "version");
  expect("4.json", with("\"spheres\"", "\"sphere\""), ErrorCode::bad_format, "'spheres' is missing");
  expect("5.json", with("\"delta\":0.1", "\"delta\":\"x\""), ErrorCode::bad_format, "'certificate.delta'");
  expect("6.json", with("\"spheres\": [", "\"spheres\": [1,"), ErrorCode::bad_format, "groups of 4");
  expect("7.json", with("\"spheres\": [", "\"spheres\": [1,1,1,1e-3,"), ErrorCode::bad_format, "larger");
  expect("8.json", with("\"triangles\":[0", "\"triangles\":[7"), ErrorCode::bad_format, "vertex 7");
  expect("9.json", with("\"triangles\":[0", "\"triangles\":[-1"), ErrorCode::bad_format, "bad index");
  expect("10.json", with("\"volume\":", "\"volume\":1e999, \"v\":"), ErrorCode::bad_format, "");
  expect("11.json", with("\"spheres\": [", "\"spheres\": [1e200,1,1,9,"), ErrorCode::not_finite, "sphere 0");
}

// Counts and depths that a file merely claims must cost nothing.
TEST(FilePacking, ClaimsOfHugeContentsAreHarmless) {
  const Scratch scratch;
  const auto expectBad = [&](const std::string& name, const std::string& bytes) {
    const std::string path = scratch.write(name, bytes);
    expectError(ErrorCode::bad_format, name, [&] { readPacking(path); });
  };
  for (const char* kind : {"\x9b", "\xbb", "\x5b", "\x7b"}) {  // array, map, bytes, text
    expectBad("huge.cbor", std::string(kind) + "\x7f\xff\xff\xff\xff\xff\xff\xff");
    expectBad("large.cbor", std::string(kind) + std::string("\0\0\0\0\xff\xff\xff\xff", 8) + "\x01");
  }
  expectBad("deep.cbor", std::string(5'000'000, '\x81'));
  expectBad("endless.cbor", std::string(5'000'000, '\x9f'));
  expectBad("tags.cbor", std::string(1'000'000, '\xc6'));
  expectBad("deep.json", std::string(5'000'000, '['));
  std::string maps;
  for (int i = 0; i < 100'000; ++i) maps += "{\"a\":";
  expectBad("maps.json", maps);
}

TEST(FilePacking, TruncatedAndFlippedFilesAreRefusedOrValid) {
  using Reader = Packing (*)(const std::string&);
  using Writer = std::string (*)(const Packing&);
  const std::vector<std::pair<Writer, Reader>> formats{
      {toJson, fromJson}, {toCbor, fromCbor}, {toXyzr, fromXyzr}};
  std::mt19937 random(3);
  for (const auto& [write, read] : formats) {
    const std::string good = write(somePacking(12));
    std::size_t accepted = 0, refused = 0;
    const auto tryOut = [&, read = read](const std::string& bytes) {
      try {
        validate(read(bytes));
        ++accepted;
      } catch (const Error&) {
        ++refused;
      }
    };
    for (std::size_t length = 0; length < good.size(); ++length) tryOut(good.substr(0, length));
    for (int trial = 0; trial < 5000; ++trial) {
      std::string bytes = good;
      const int flips = 1 + trial % 3;
      for (int i = 0; i < flips; ++i) {
        char& byte = bytes[std::uniform_int_distribution<std::size_t>(0, bytes.size() - 1)(random)];
        byte = static_cast<char>(trial % 2 ? byte ^ (1 << (random() % 8)) : random());
      }
      if (trial % 5 == 0)
        bytes.insert(random() % bytes.size(), bytes.substr(random() % bytes.size(), random() % 50));
      tryOut(bytes);
    }
    EXPECT_GT(accepted, 0u);
    EXPECT_GT(refused, 1000u);
  }
}

}  // namespace
}  // namespace innersphere::test

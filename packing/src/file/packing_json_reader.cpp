#include <algorithm>
#include <array>
#include <bit>
#include <nlohmann/json.hpp>

#include "file/packing_json.hpp"
#include "file/packing_schema.hpp"
#include "innersphere/error.hpp"

namespace innersphere {
namespace {

using nlohmann::json;

[[noreturn]] void damaged(const std::string& what) {
  throw Error(ErrorCode::bad_format, what + "; the file is damaged or not a packing");
}

// An entry with its path, so that messages can name it.
class Entry {
 public:
  Entry(const json& value, std::string path) : value_(value), path_(std::move(path)) {}

  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }

  Entry operator[](const std::string& key) const {
    if (!value_.is_object()) damaged("'" + path_ + "' is not an object");
    const auto found = value_.find(key);
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (found == value_.end()) damaged("'" + path + "' is missing");
    return {*found, path};
  }

  std::vector<Entry> items() const {
    if (!value_.is_array()) damaged("'" + path_ + "' is not an array");
    std::vector<Entry> all;
    for (const json& item : value_) all.emplace_back(item, path_ + "[" + std::to_string(all.size()) + "]");
    return all;
  }

  double number() const {
    if (!value_.is_number()) damaged("'" + path_ + "' is not a number");
    return value_.get<double>();
  }

  std::string text() const {
    if (!value_.is_string()) damaged("'" + path_ + "' is not a text");
    return value_.get<std::string>();
  }

  template <std::size_t n>
  std::array<double, n> numbers() const {
    if (!value_.is_array() || value_.size() != n)
      damaged("'" + path_ + "' is not " + std::to_string(n) + " numbers");
    std::array<double, n> all;
    for (std::size_t i = 0; i < n; ++i) all[i] = Entry(value_[i], path_).number();
    return all;
  }

  Vec3d vector() const {
    const std::array<double, 3> v = numbers<3>();
    return {v[0], v[1], v[2]};
  }

  /// All numbers of an array or of a byte string; their count must be a multiple of `group`.
  std::vector<float> floats(std::size_t group) const {
    return list<float>(
        group, [&](const json& x) { return static_cast<float>(Entry(x, path_).number()); },
        [](std::uint32_t word) { return std::bit_cast<float>(word); });
  }

  std::uint32_t index() const {
    if (!value_.is_number_unsigned() || value_.get<std::uint64_t>() > UINT32_MAX)
      damaged("'" + path_ + "' has a bad index");
    return value_.get<std::uint32_t>();
  }

  std::vector<std::uint32_t> indices(std::size_t group) const {
    return list<std::uint32_t>(
        group, [&](const json& x) { return Entry(x, path_).index(); },
        [](std::uint32_t word) { return word; });
  }

 private:
  template <class T, class FromNumber, class FromWord>
  std::vector<T> list(std::size_t group, const FromNumber& from_number, const FromWord& from_word) const {
    std::vector<T> all;
    if (value_.is_array()) {
      all.reserve(value_.size());
      for (const json& x : value_) all.push_back(from_number(x));
    } else if (value_.is_binary() && value_.get_binary().size() % 4 == 0) {
      const auto& bytes = value_.get_binary();
      all.reserve(bytes.size() / 4);
      for (std::size_t i = 0; i < bytes.size(); i += 4) {
        const std::uint32_t word =
            bytes[i] | bytes[i + 1] << 8 | bytes[i + 2] << 16 | std::uint32_t{bytes[i + 3]} << 24;
        all.push_back(from_word(word));
      }
    } else {
      damaged("'" + path_ + "' is not a list of numbers");
    }
    if (all.size() % group != 0) damaged("'" + path_ + "' is not in groups of " + std::to_string(group));
    return all;
  }

  const json& value_;
  std::string path_;
};

void requireVersion(const Entry& document) {
  const std::string format = document.has("format") ? document["format"].text() : "";
  if (format == kCoveringFormat) {
    throw Error(
        ErrorCode::bad_format,
        "these spheres cover a solid: they overlap each other and reach out of it, so the volumes that they "
        "share mean nothing; this needs a packing, from `innersphere pack` without --cover");
  }
  if (format == kClumpFormat) {
    throw Error(ErrorCode::bad_format,
                "these spheres are a clump: they overlap each other and reach out of their solid, so the "
                "volumes that they share mean nothing; this needs a packing, from `innersphere pack` without "
                "--clump");
  }
  if (format != kPackingFormat) {
    throw Error(ErrorCode::bad_format,
                "this is not a packing file (no format '" + std::string(kPackingFormat) + "')");
  }
  const double version = document["version"].number();
  if (version > kPackingFormatVersion) {
    throw Error(
        ErrorCode::unsupported_version,
        "the packing file has version " + std::to_string(static_cast<long long>(std::min(version, 1e9))) +
            ", this program reads up to " + std::to_string(kPackingFormatVersion) + "; use a newer one");
  }
  if (version != 1 && version != kPackingFormatVersion) damaged("'version' is not a version");
}

SphereOrder orderOf(const Entry& entry) {
  const std::string name = entry.text();
  if (name != "radius" && name != "coverage") damaged("'order' is not one that this version knows");
  return name == "coverage" ? SphereOrder::coverage : SphereOrder::radius;
}

std::vector<Coverage> coverageOf(const Entry& entry) {
  std::vector<Coverage> prefixes;
  for (const Entry& prefix : entry.items()) {
    prefixes.push_back({prefix["count"].index(), prefix["mean"].number(), prefix["p95"].number(),
                        prefix["max"].number(), prefix["farthest"].vector(), prefix["uncovered"].number()});
  }
  return prefixes;
}

std::vector<OverlapErrors::AtDepth> errorsOf(const Entry& entry) {
  std::vector<OverlapErrors::AtDepth> rows;
  for (const Entry& row : entry.items())
    rows.push_back({row["depth"].number(), {row["mean"].number(), row["bound"].number()}});
  return rows;
}

/// Returns the errors of a prefix with one kind of radii. The first files know nothing of planes.
OverlapErrors::Estimate estimateOf(const Entry& prefix, const char* radii, const char* radii_of_planes) {
  OverlapErrors::Estimate estimate{errorsOf(prefix[radii]), 0, {}};
  if (prefix.has(radii_of_planes)) {
    const Entry planes = prefix[radii_of_planes];
    estimate.thickest = planes["thicker_than"].number();
    estimate.planes = errorsOf(planes["errors"]);
  }
  return estimate;
}

OverlapErrors overlapErrorsOf(const Entry& entry) {
  OverlapErrors errors;
  errors.poses = entry["poses"].index();
  errors.shallowest = entry["shallowest"].number();
  errors.sampling_error = entry["sampling_error"].number();
  for (const Entry& prefix : entry["prefixes"].items()) {
    errors.prefixes.push_back({prefix["count"].index(), estimateOf(prefix, "raw", "raw_planes"),
                               estimateOf(prefix, "volume_true", "volume_true_planes")});
  }
  return errors;
}

Surface surfaceOf(const Entry& entry) {
  Surface surface;
  const std::vector<float> v = entry["vertices"].floats(3);
  for (std::size_t i = 0; i < v.size(); i += 3) surface.vertices.push_back({v[i], v[i + 1], v[i + 2]});
  const std::vector<std::uint32_t> t = entry["triangles"].indices(3);
  for (std::size_t i = 0; i < t.size(); i += 3) surface.triangles.push_back({t[i], t[i + 1], t[i + 2]});
  return surface;
}

Packing packingOf(const json& value) {
  const Entry document(value, "");
  requireVersion(document);
  Packing packing;
  const std::vector<float> s = document["spheres"].floats(4);
  for (std::size_t i = 0; i < s.size(); i += 4)
    packing.spheres.push_back({s[i], s[i + 1], s[i + 2], s[i + 3]});
  for (const Entry& prefix : document["volume_true"].items()) {
    VolumeTrueRadii radii;
    radii.radii = prefix["radii"].floats(1);
    radii.count = static_cast<std::uint32_t>(std::min<std::size_t>(radii.radii.size(), UINT32_MAX));
    radii.sampling_error = prefix["sampling_error"].number();
    packing.volume_true.push_back(std::move(radii));
  }
  packing.surface = surfaceOf(document["surface"]);
  // Entries that came later than the first files.
  if (document.has("origin")) packing.origin = document["origin"].vector();
  if (document.has("order")) packing.order = orderOf(document["order"]);
  if (document.has("coverage")) packing.coverage = coverageOf(document["coverage"]);
  if (document.has("errors_by_depth")) packing.overlap_errors = overlapErrorsOf(document["errors_by_depth"]);
  if (document.has("mass_weights")) packing.mass_weights = document["mass_weights"].floats(1);
  if (document.has("warnings")) {
    for (const Entry& warning : document["warnings"].items()) packing.warnings.push_back(warning.text());
  }
  // Means of four bins, 2 to 4 times too small for shallow overlaps; errors relative to the truth; and errors
  // by volume, up to 6 times too small where walls lie along walls.
  if (document.has("overlap_errors") || document.has("expected_errors") || document.has("volume_errors")) {
    packing.warnings.push_back(
        "the file's estimates of errors are of an older kind and are left out; pack the solid again to have "
        "them");
  }

  const Entry solid = document["solid"];
  packing.solid = {solid["volume"].number(), solid["centre_of_mass"].vector(), solid["inertia"].numbers<9>()};
  const Entry certificate = document["certificate"];
  packing.certificate = {certificate["delta"].number(), certificate["largest_missing_radius"].number()};
  const Entry quality = document["quality"];
  packing.quality = {quality["density"].number(), quality["gap_mean"].number(), quality["gap_p95"].number(),
                     quality["gap_max"].number()};
  const Entry provenance = document["provenance"];
  packing.provenance = {provenance["source"].text(), provenance["source_hash"].text(),
                        provenance["options"].text(), provenance["innersphere_version"].text()};
  return packing;
}

// Ends a parse that goes deeper than any packing does: the CBOR parser recurses, and a few megabytes of
// opening brackets would use up the stack.
class DepthLimit : public nlohmann::json_sax<json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool key(string_t&) override { return true; }
  bool start_object(std::size_t) override { return ++depth_ <= kDeepest; }
  bool start_array(std::size_t) override { return ++depth_ <= kDeepest; }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    damaged(error.what());
  }

 private:
  static constexpr int kDeepest = 16;
  bool leave() {
    --depth_;
    return true;
  }
  int depth_ = 0;
};

Packing read(const std::string& bytes, json::input_format_t format) {
  try {
    DepthLimit limit;
    if (!json::sax_parse(bytes, &limit, format)) damaged("entries are nested too deeply");
    return packingOf(format == json::input_format_t::cbor ? json::from_cbor(bytes) : json::parse(bytes));
  } catch (const json::exception& error) {
    damaged(error.what());
  }
}

}  // namespace

Packing fromJson(const std::string& text) {
  return read(text, json::input_format_t::json);
}
Packing fromCbor(const std::string& bytes) {
  return read(bytes, json::input_format_t::cbor);
}

}  // namespace innersphere

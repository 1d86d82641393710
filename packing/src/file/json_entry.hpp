// Reads entries of JSON and CBOR files, and names the one that is wrong.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "innersphere/packing.hpp"

namespace innersphere {

/// Throws Error: bad_format, with `what` and that the file is damaged.
[[noreturn]] void damaged(const std::string& what);
/// The same, with what a parser says.
[[noreturn]] void damaged(const nlohmann::json::exception& error);

/// Parses a file. Any bytes are safe: memory is bounded by a small multiple of their number. Throws Error:
/// bad_format, nlohmann::json::exception.
nlohmann::json parseJson(const std::string& bytes, nlohmann::json::input_format_t format);

/// An entry with its path, so that messages can name it. Each reader throws Error: bad_format.
class JsonEntry {
 public:
  JsonEntry(const nlohmann::json& value, std::string path) : value_(value), path_(std::move(path)) {}

  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }

  JsonEntry operator[](const std::string& key) const {
    if (!value_.is_object()) damaged("'" + path_ + "' is not an object");
    const auto found = value_.find(key);
    const std::string path = path_.empty() ? key : path_ + "." + key;
    if (found == value_.end()) damaged("'" + path + "' is missing");
    return {*found, path};
  }

  std::vector<JsonEntry> items() const {
    if (!value_.is_array()) damaged("'" + path_ + "' is not an array");
    std::vector<JsonEntry> all;
    for (const nlohmann::json& item : value_)
      all.emplace_back(item, path_ + "[" + std::to_string(all.size()) + "]");
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
    for (std::size_t i = 0; i < n; ++i) all[i] = JsonEntry(value_[i], path_).number();
    return all;
  }

  Vec3d vector() const {
    const std::array<double, 3> v = numbers<3>();
    return {v[0], v[1], v[2]};
  }

  /// All numbers of an array or of a byte string; their count must be a multiple of `group`.
  std::vector<float> floats(std::size_t group) const {
    return list<float>(
        group, [&](const nlohmann::json& x) { return static_cast<float>(JsonEntry(x, path_).number()); },
        [](std::uint32_t word) { return std::bit_cast<float>(word); });
  }

  std::uint32_t index() const {
    if (!value_.is_number_unsigned() || value_.get<std::uint64_t>() > UINT32_MAX)
      damaged("'" + path_ + "' has a bad index");
    return value_.get<std::uint32_t>();
  }

  std::vector<std::uint32_t> indices(std::size_t group) const {
    return list<std::uint32_t>(
        group, [&](const nlohmann::json& x) { return JsonEntry(x, path_).index(); },
        [](std::uint32_t word) { return word; });
  }

 private:
  template <class T, class FromNumber, class FromWord>
  std::vector<T> list(std::size_t group, const FromNumber& from_number, const FromWord& from_word) const {
    std::vector<T> all;
    if (value_.is_array()) {
      all.reserve(value_.size());
      for (const nlohmann::json& x : value_) all.push_back(from_number(x));
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

  const nlohmann::json& value_;
  std::string path_;
};

/// Returns the mass properties that an entry holds.
MassProperties massPropertiesOf(const JsonEntry& entry);
/// Returns where it says that a file comes from.
Provenance provenanceOf(const JsonEntry& entry);

/// Returns what `read` makes of a file. Any bytes are safe, as with parseJson(). Throws Error: bad_format,
/// and what `read` throws.
template <class Read>
auto readJson(const std::string& bytes, nlohmann::json::input_format_t format, const Read& read) {
  try {
    const nlohmann::json document = parseJson(bytes, format);
    return read(JsonEntry(document, ""));
  } catch (const nlohmann::json::exception& error) {
    damaged(error);
  }
}

}  // namespace innersphere

#include "mesh/import/unit_3mf.hpp"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <limits>

#include "innersphere/error.hpp"
#include "mesh/import/byte_cursor.hpp"

namespace innersphere {
namespace {

// The model's first element is within so many bytes.
constexpr std::size_t kHead = 1 << 16;

constexpr std::string_view kMainModel = "3d/3dmodel.model", kWhite = " \t\r\n";

const LengthUnit kUnits[] = {{"millimeter", 1e-3}, {"micron", 1e-6}, {"centimeter", 1e-2},
                             {"inch", 0.0254},     {"foot", 0.3048}, {"meter", 1}};

/// A file in an archive, as its directory lists it.
struct Entry {
  bool compressed;
  std::uint32_t size, local_header;
};

ByteCursor cursorAt(std::string_view bytes, std::size_t at) {
  static const std::string nowhere;  // what it throws is not shown
  ByteCursor cursor(bytes, nowhere);
  cursor.skip(at);
  return cursor;
}

/// Finds the model in the directory at the end of a zip archive.
std::optional<Entry> findModel(std::string_view bytes) {
  constexpr std::string_view kEnd("PK\5\6", 4);
  const std::size_t end = bytes.rfind(kEnd);
  if (end == std::string_view::npos) return std::nullopt;
  ByteCursor tail = cursorAt(bytes, end + 10);
  const auto count = tail.take<std::uint16_t>();
  tail.skip(4);
  ByteCursor directory = cursorAt(bytes, tail.take<std::uint32_t>());
  std::optional<Entry> model;
  for (int i = 0; i < count; ++i) {
    Entry entry{};
    directory.skip(10);
    entry.compressed = directory.take<std::uint16_t>() != 0;
    directory.skip(8);
    entry.size = directory.take<std::uint32_t>();
    directory.skip(4);
    const auto name_size = directory.take<std::uint16_t>(), extra = directory.take<std::uint16_t>(),
               comment = directory.take<std::uint16_t>();
    directory.skip(8);
    entry.local_header = directory.take<std::uint32_t>();
    std::string name(bytes.substr(directory.place(), name_size));
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    directory.skip(std::size_t{name_size} + extra + comment);
    if (name == kMainModel) return entry;
    if (name.ends_with(".model") && !model) model = entry;
  }
  return model;
}

std::string inflated(std::string_view bytes) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  std::string head(kHead, 0);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(std::min<std::size_t>(bytes.size(), std::numeric_limits<uInt>::max()));
  stream.next_out = reinterpret_cast<Bytef*>(head.data());
  stream.avail_out = static_cast<uInt>(head.size());
  inflate(&stream, Z_SYNC_FLUSH);  // of damaged bytes the part before is there
  head.resize(head.size() - stream.avail_out);
  inflateEnd(&stream);
  return head;
}

std::string headOf(std::string_view bytes, const Entry& entry) {
  ByteCursor local = cursorAt(bytes, std::size_t{entry.local_header} + 26);
  const auto name = local.take<std::uint16_t>(), extra = local.take<std::uint16_t>();
  local.skip(std::size_t{name} + extra);
  const std::string_view content = bytes.substr(local.place(), entry.size);
  return entry.compressed ? inflated(content) : std::string(content.substr(0, kHead));
}

/// The value of the attribute `unit` of the element `model`, empty if it has none; nothing without the
/// element.
std::optional<std::string> unitIn(std::string_view xml) {
  const std::size_t begin = xml.find("<model");
  if (begin == std::string_view::npos) return std::nullopt;
  const std::string_view tag = xml.substr(begin, xml.find('>', begin) - begin);
  for (std::size_t at = tag.find("unit"); at != std::string_view::npos; at = tag.find("unit", at + 1)) {
    if (kWhite.find(tag[at - 1]) == std::string_view::npos) continue;
    std::string_view rest = tag.substr(at + 4);
    const auto skipWhite = [&] { rest.remove_prefix(std::min(rest.find_first_not_of(kWhite), rest.size())); };
    skipWhite();
    if (!rest.starts_with('=')) continue;
    rest.remove_prefix(1);
    skipWhite();
    if (rest.empty()) return std::nullopt;
    return std::string(rest.substr(1, rest.find(rest[0], 1) - 1));
  }
  return std::string();
}

}  // namespace

std::optional<LengthUnit> unitOf3mf(std::string_view bytes) {
  try {
    const std::optional<Entry> model = findModel(bytes);
    const std::optional<std::string> name = model ? unitIn(headOf(bytes, *model)) : std::nullopt;
    if (!name) return std::nullopt;
    if (name->empty()) return kUnits[0];
    const auto unit = std::find_if(std::begin(kUnits), std::end(kUnits),
                                   [&](const LengthUnit& u) { return u.name == *name; });
    return unit == std::end(kUnits) ? std::nullopt : std::optional(*unit);
  } catch (const Error&) {
    return std::nullopt;  // the archive is damaged, or larger than 4 GB
  }
}

}  // namespace innersphere

#include "shard.hpp"

#include <charconv>
#include <istream>
#include <sstream>

#include "innersphere/error.hpp"

namespace innersphere::tool {
namespace {

constexpr std::size_t kMostShards = 1000000;  // rows * count stays far below 2^64

// Reads "I/N".
bool parseShard(const std::string& text, Shard& shard) {
  const char* end = text.data() + text.size();
  const auto [slash, no_index] = std::from_chars(text.data(), end, shard.index);
  if (no_index != std::errc() || slash == end || *slash != '/') return false;
  const auto [stop, no_count] = std::from_chars(slash + 1, end, shard.count);
  return no_count == std::errc() && stop == end && shard.index >= 1 && shard.index <= shard.count &&
         shard.count <= kMostShards;
}

}  // namespace

std::string toText(const ShardLine& line) {
  return "# shard " + std::to_string(line.shard.index) + "/" + std::to_string(line.shard.count) + " of " +
         std::to_string(line.rows) + " rows, job " + line.job + "\n";
}

ShardLine readShardLine(std::istream& file, const std::string& path) {
  std::string text;
  std::getline(file, text);
  std::stringstream words(text);
  std::string hash, kind, part, of, rows, job_word;
  ShardLine line;
  words >> hash >> kind >> part >> of >> line.rows >> rows >> job_word >> line.job;
  if (!words || hash != "#" || kind != "shard" || job_word != "job" || !parseShard(part, line.shard)) {
    throw Error(ErrorCode::bad_format, path + " is not a shard: it was not written with --shard I/N");
  }
  return line;
}

void addShardOption(Command& command, Shard& shard) {
  std::string none;
  Option& option = command.text("--shard", none,
                                "I/N: only the I-th of N parts of the poses, I from 1; innersphere merge "
                                "puts the files together");
  option.value_name = "I/N";
  option.take = [&shard](const std::string& text) -> std::string {
    if (parseShard(text, shard)) return {};
    return text + " is not I/N with whole numbers from 1 to N, such as 3/8";
  };
}

}  // namespace innersphere::tool

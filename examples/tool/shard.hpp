// Tables that are computed in parts, on several machines, and put together again.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>

#include "command.hpp"

namespace innersphere::tool {

/// A part of a table: the index-th of `count` ranges of rows, from 1. 1 of 1 is all of it.
struct Shard {
  std::size_t index = 1;
  std::size_t count = 1;

  bool whole() const { return count == 1; }
  /// The rows [firstRow, endRow) of a table of `rows`. Together, all shards have each row once, in order.
  std::size_t firstRow(std::size_t rows) const { return rows * (index - 1) / count; }
  std::size_t endRow(std::size_t rows) const { return rows * index / count; }
};

/// The first line of the file of a shard. It says which part of which table follows.
struct ShardLine {
  Shard shard;
  std::size_t rows = 0;  ///< of the whole table
  std::string job;       ///< the same for all shards of a table: made of all that its numbers depend on
};

std::string toText(const ShardLine& line);
/// Reads the first line of a file. Throws Error bad_format if it is not that of a shard; `path` is named.
ShardLine readShardLine(std::istream& file, const std::string& path);

/// Adds --shard.
void addShardOption(Command& command, Shard& shard);

}  // namespace innersphere::tool

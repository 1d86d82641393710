#include <algorithm>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "exit_codes.hpp"
#include "innersphere/error.hpp"
#include "outputs.hpp"
#include "shard.hpp"

namespace innersphere::tool {
namespace {

struct Arguments {
  std::vector<std::string> shards;
  std::string output;
  bool force = false;
};

struct Part {
  std::string path;
  ShardLine line;
};

std::ifstream open(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::file_not_found, "cannot open " + path);
  return file;
}

// Throws unless the parts, which are sorted, are all of one table.
void checkComplete(const std::vector<Part>& parts) {
  const ShardLine& first = parts.front().line;
  std::string missing;
  std::size_t next = 1;
  for (const Part& part : parts) {
    const ShardLine& line = part.line;
    if (line.job != first.job || line.rows != first.rows || line.shard.count != first.shard.count) {
      throw Error(ErrorCode::bad_format, part.path + " and " + parts.front().path +
                                             " are of different tables: packings, poses, options and the "
                                             "number of shards must be the same");
    }
    if (line.shard.index < next) {
      throw Error(ErrorCode::bad_format,
                  part.path + " is shard " + std::to_string(line.shard.index) + ", which is there twice");
    }
    for (; next < line.shard.index; ++next) missing += " " + std::to_string(next);
    ++next;
  }
  for (; next <= first.shard.count; ++next) missing += " " + std::to_string(next);
  if (!missing.empty()) {
    throw Error(ErrorCode::bad_format, "these shards of " + std::to_string(first.shard.count) +
                                           " are missing:" + missing +
                                           "; run innersphere overlap again for them");
  }
}

// Appends the rows of a part, and of the first also the row of names.
void append(const Part& part, bool with_names, std::ofstream& table) {
  std::ifstream file = open(part.path);
  readShardLine(file, part.path);
  std::string row;
  std::getline(file, row);
  if (with_names) table << row << '\n';
  const Shard& shard = part.line.shard;
  const std::size_t rows = shard.endRow(part.line.rows) - shard.firstRow(part.line.rows);
  std::size_t count = 0;
  for (; std::getline(file, row) && !file.eof(); ++count) table << row << '\n';
  if (count != rows || !row.empty()) {
    throw Error(ErrorCode::bad_format, part.path + " has " + std::to_string(count) + " whole rows of " +
                                           std::to_string(rows) + ": it is damaged; run its shard again");
  }
}

void run(const Arguments& arguments) {
  checkOutput(arguments.output, arguments.force);
  std::vector<Part> parts;
  for (const std::string& path : arguments.shards) {
    std::ifstream file = open(path);
    parts.push_back({path, readShardLine(file, path)});
  }
  std::sort(parts.begin(), parts.end(),
            [](const Part& a, const Part& b) { return a.line.shard.index < b.line.shard.index; });
  checkComplete(parts);
  writeOutput(arguments.output, arguments.force, [&](const std::string& temporary) {
    std::ofstream table(temporary, std::ios::binary);
    for (const Part& part : parts) append(part, &part == &parts.front(), table);
    table.close();
    if (!table) throw Error(ErrorCode::write_failed, "cannot write " + arguments.output);
  });
}

}  // namespace

Command mergeCommand() {
  Command command("merge", "Put the shards of an overlap table together");
  auto arguments = std::make_shared<Arguments>();
  command
      .arguments("SHARD", arguments->shards, "Files that innersphere overlap --shard I/N wrote, in any order")
      .withFile()
      .required = true;
  Option& output = command.text("-o,--output", arguments->output, "CSV file to write; -: to stdout");
  output.withFile().required = true;
  command.flag("--force", arguments->force, "Replace an existing output");
  command.notes =
      "The table has the same bytes as if it had been computed at once. Shards that are missing are named.";
  command.examples = {"innersphere merge part-*.csv -o overlap.csv"};
  command.run = [arguments] {
    run(*arguments);
    return kOk;
  };
  return command;
}

}  // namespace innersphere::tool

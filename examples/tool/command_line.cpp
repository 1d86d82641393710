#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "exit_codes.hpp"
#include "suggestion.hpp"

namespace innersphere::tool {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

// Help is so wide, and its first column.
constexpr std::size_t kWidth = 100, kFirstColumn = 34;

// Begins a new line before each word that would end beyond the width.
std::string wrapped(const std::string& text, std::size_t width) {
  std::string result;
  std::size_t column = 0;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool fits = column + 1 + word.size() <= width;
    if (column > 0) result += fits ? ' ' : '\n';
    result += word;
    column = column > 0 && fits ? column + 1 + word.size() : word.size();
  }
  return result;
}

std::string typeOf(const Option& option) {
  if (option.isArgument()) return "";
  if (option.only_choices) return "{" + CLI::detail::join(option.choices, ",") + "}";
  return option.takes_file ? "FILE" : option.value_name;
}

void take(const Option& option, const std::string& value) {
  const auto& names = option.choices;
  const std::string name = option.isArgument() ? option.name : option.spellings().back();
  if (option.only_choices && std::find(names.begin(), names.end(), value) == names.end()) {
    // All of a few names tell more than a guess.
    constexpr std::size_t kFew = 6;
    const std::string all = "; it must be one of " + listed(names);
    throw UsageError(name + ": there is no \"" + value + "\"" +
                     (names.size() <= kFew ? all : didYouMean(value, names, all)));
  }
  const std::string wrong = option.take(value);
  if (!wrong.empty()) throw UsageError(name + ": " + wrong);
}

void addOption(CLI::App& app, const Option& option) {
  const std::string description = wrapped(option.description, kWidth - kFirstColumn);
  if (option.isFlag()) {
    app.add_flag_callback(
        option.name, [&option] { take(option, ""); }, description);
    return;
  }
  const auto takeAll = [&option](const CLI::results_t& values) {
    for (const std::string& value : values) take(option, value);
    return true;
  };
  CLI::Option* added = app.add_option(option.name, takeAll, description);
  added->type_name(typeOf(option))->default_str(option.default_text)->required(option.required);
  if (option.repeated && option.isArgument()) {
    added->expected(0, CLI::detail::expected_max_vector_size)->allow_extra_args();
  }
  // Of an option that is given twice the last one counts, so that scripts can pass on what they were given.
  if (!option.isArgument()) option.repeated ? added->take_all() : added->take_last();
}

std::string footerOf(const Command& command) {
  std::string text;
  const auto append = [&text](const std::string& part, const char* separator) {
    if (!part.empty()) text += (text.empty() ? "" : separator) + part;
  };
  append(wrapped(command.notes, kWidth), "\n");
  append(wrapped(command.exit_status, kWidth), "\n");
  std::string examples;
  for (const std::string& example : command.examples) examples += "\n  " + example;
  if (!examples.empty()) append((command.examples.size() == 1 ? "Example:" : "Examples:") + examples, "\n\n");
  return text;
}

// CLI11's view of one command; it refers to the command's options.
void fill(CLI::App& app, const Command& command, const std::string& path,
          const std::vector<Option>& everywhere) {
  app.name(path);
  app.description(command.description + ".");
  app.footer(footerOf(command));
  app.set_help_flag("-h,--help", "Print this help");
  app.get_formatter()->column_width(kFirstColumn);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.allow_extras();
  for (const Option& option : command.options) addOption(app, option);
  for (const Option& option : everywhere) addOption(app, option);
  for (const Command& sub : command.commands)
    app.add_subcommand(sub.name, wrapped(sub.description, kWidth - kFirstColumn))->group("Commands");
}

[[noreturn]] void failWithExtra(const Command& command, const std::vector<Option>& everywhere,
                                const std::string& path, std::vector<std::string> extras) {
  const auto isOption = [](const std::string& word) { return word.size() > 1 && word[0] == '-'; };
  const auto option = std::find_if(extras.begin(), extras.end(), isOption);
  if (option == extras.end()) throw UsageError(path + " has no place for \"" + extras.front() + "\"");
  std::vector<std::string> names{"--help"};
  for (const auto* options : {&command.options, &everywhere}) {
    for (const Option& known : *options) {
      for (const std::string& name : known.spellings()) names.push_back(name);
    }
  }
  const std::string typed = option->substr(0, option->find('='));
  throw UsageError(path + " has no option " + typed + didYouMean(typed, names, ""));
}

std::string helpOfCommand(const Command& command, const std::string& path,
                          const std::vector<Option>& everywhere) {
  CLI::App app;
  fill(app, command, path, everywhere);
  return app.help();
}

void appendHelpOfAll(const Command& command, const std::string& path, const std::vector<Option>& everywhere,
                     std::string& text) {
  text += (text.empty() ? "" : "\n\n") + helpOfCommand(command, path, everywhere);
  for (const Command& sub : command.commands) {
    appendHelpOfAll(sub, path + " " + sub.name, everywhere, text);
  }
}

}  // namespace

Found findCommand(const Command& root, const std::vector<std::string>& words) {
  Found found{&root, root.name, {}};
  std::size_t next = 0;
  for (; next < words.size() && words[next] != "--" && !found.command->commands.empty(); ++next) {
    const std::string& word = words[next];
    if (word.size() > 1 && word[0] == '-') {
      found.words.push_back(word);
      continue;
    }
    const Command* command = found.command->find(word);
    if (!command) {
      throw UsageError(
          "there is no command \"" + word + "\"" +
          didYouMean(word, found.command->namesOfCommands(), "; " + found.path + " --help lists them"));
    }
    found.command = command;
    found.path += " " + word;
  }
  found.words.insert(found.words.end(), words.begin() + static_cast<std::ptrdiff_t>(next), words.end());
  return found;
}

int runCommandLine(const Command& root, const std::vector<Option>& everywhere,
                   const std::vector<std::string>& words) {
  const Found found = findCommand(root, words);
  const Command& command = *found.command;
  CLI::App app;
  fill(app, command, found.path, everywhere);
  try {
    app.parse(std::vector<std::string>(found.words.rbegin(), found.words.rend()));
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    return kOk;
  } catch (const CLI::ParseError& error) {
    // An unknown option tells more than what is missing because of it.
    if (!app.remaining().empty()) failWithExtra(command, everywhere, found.path, app.remaining());
    throw UsageError(std::string(error.what()) + "; " + found.path + " --help tells more");
  }
  if (!app.remaining().empty()) failWithExtra(command, everywhere, found.path, app.remaining());
  if (command.run) return command.run();
  std::fputs(app.help().c_str(), stderr);
  return kBadUsage;
}

std::string helpOf(const Command& root, const std::vector<Option>& everywhere,
                   const std::vector<std::string>& words) {
  const Found found = findCommand(root, words);
  return helpOfCommand(*found.command, found.path, everywhere);
}

std::string helpOfAll(const Command& root, const std::vector<Option>& everywhere) {
  std::string text;
  appendHelpOfAll(root, root.name, everywhere, text);
  return text;
}

}  // namespace innersphere::tool

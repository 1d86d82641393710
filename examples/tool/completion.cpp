#include <functional>

#include "documentation.hpp"

namespace innersphere::tool {
namespace {

using Visit = std::function<void(const Command& command, const std::vector<std::string>& path)>;

// Each command with the words that lead to it; the tool itself comes first, without any.
void visit(const Command& command, std::vector<std::string>& path, const Visit& function) {
  function(command, path);
  for (const Command& sub : command.commands) {
    path.push_back(sub.name);
    visit(sub, path, function);
    path.pop_back();
  }
}

void visitAll(const Command& root, const Visit& function) {
  std::vector<std::string> path;
  visit(root, path, function);
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

// In single quotes, for bash and zsh.
std::string shellQuoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::vector<Option> optionsOf(const Command& command, const std::vector<Option>& everywhere) {
  std::vector<Option> options = command.options;
  options.insert(options.end(), everywhere.begin(), everywhere.end());
  Option& help = options.emplace_back();
  help.name = "-h,--help";
  help.description = "Print this help";
  return options;
}

// bash: the words of a command are joined with a space before each.

std::string bashOffer(const Option& option) {
  return "names=" + shellQuoted(joined(option.choices, " ")) + (option.takes_file ? " files=1" : "");
}

// zsh: what _arguments wants.

std::string zshText(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string zshValue(const Option& option) {
  const std::string names = joined(option.choices, " ");
  std::string action = " ";
  if (option.takes_file) action = "_files";
  if (!names.empty()) action = option.takes_file ? " _innersphere_or_file " + names : "(" + names + ")";
  return ":" + (option.isArgument() ? option.name : option.value_name) + ":" + action;
}

std::string zshSpec(const Option& option) {
  if (option.isArgument()) return shellQuoted((option.repeated ? "*" : "") + zshValue(option));
  const std::vector<std::string> names = option.spellings();
  const std::string rest =
      shellQuoted("[" + zshText(option.description) + "]" + (option.isFlag() ? "" : zshValue(option)));
  if (names.size() == 1) return (option.repeated ? "'*'" : "") + names[0] + rest;
  return "'(" + joined(names, " ") + ")'{" + joined(names, ",") + "}" + rest;
}

std::string zshFunction(const std::vector<std::string>& path) {
  return "_innersphere" + (path.empty() ? "" : "_" + joined(path, "_"));
}

// fish: a line for each option, with the condition that its command was given.

std::string fishText(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c;
  }
  return result + "'";
}

std::string fishCondition(const Command& command, const std::vector<std::string>& path) {
  std::vector<std::string> parts;
  for (const std::string& word : path) parts.push_back("__fish_seen_subcommand_from " + word);
  // "check" is a command, and one of the group "scene".
  if (path.size() == 1 && path[0] != "scene") parts.push_back("not __fish_seen_subcommand_from scene");
  if (!command.commands.empty()) {
    parts.push_back("not __fish_seen_subcommand_from " + joined(command.namesOfCommands(), " "));
  }
  return " -n " + fishText(joined(parts, "; and "));
}

std::string fishLine(const Option& option, const std::string& condition) {
  std::string line = "complete -c innersphere" + condition;
  for (const std::string& name : option.spellings()) {
    line += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (!option.isFlag() && !option.isArgument()) line += option.takes_file ? " -rF" : " -x";
  if (option.isArgument() && option.takes_file) line += " -F";
  if (!option.choices.empty()) line += " -a " + fishText(joined(option.choices, " "));
  return line + (option.isArgument() ? "" : " -d " + fishText(option.description)) + "\n";
}

}  // namespace

std::string bashCompletion(const Command& root, const std::vector<Option>& everywhere) {
  std::string commands, values, offers;
  visitAll(root, [&](const Command& command, const std::vector<std::string>& path) {
    const std::string words = path.empty() ? "" : " " + joined(path, " ");
    if (!path.empty()) commands += (commands.empty() ? "" : "|") + shellQuoted(words);
    std::string names, arguments = "names=" + shellQuoted(joined(command.namesOfCommands(), " "));
    for (const Option& option : optionsOf(command, everywhere)) {
      if (option.isArgument()) arguments = bashOffer(option);
      for (const std::string& name : option.spellings()) {
        names += (names.empty() ? "" : " ") + name;
        if (!option.isFlag()) {
          values += "    " + shellQuoted(words + " " + name) + ") " + bashOffer(option) + " option=1 ;;\n";
        }
      }
    }
    offers += "    " + shellQuoted(words + " -") + ") names=" + shellQuoted(names) + " ;;\n";
    offers += "    " + shellQuoted(words + " ") + ") " + arguments + " ;;\n";
  });
  return "# bash completion of innersphere, written by: innersphere completion bash\n"
         "_innersphere() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "  local command='' names='' files='' option='' dash='' i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    case \"$command ${COMP_WORDS[i]}\" in\n      " +
         commands +
         ") command+=\" ${COMP_WORDS[i]}\" ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$command $previous\" in\n" +
         values +
         "  esac\n"
         "  [[ $current == -* ]] && dash=-\n"
         "  [[ $option ]] || case \"$command $dash\" in\n" +
         offers +
         "  esac\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$names\" -- \"$current\"; [[ ! $files ]] || compgen -f -- "
         "\"$current\")\n"
         "}\n"
         "complete -o filenames -F _innersphere innersphere\n";
}

std::string zshCompletion(const Command& root, const std::vector<Option>& everywhere) {
  std::string text =
      "#compdef innersphere\n"
      "# zsh completion of innersphere, written by: innersphere completion zsh\n"
      "_innersphere_or_file() {\n  compadd -- \"$@\"\n  _files\n}\n";
  visitAll(root, [&](const Command& command, const std::vector<std::string>& path) {
    text += "\n" + zshFunction(path) + "() {\n";
    const bool group = !command.commands.empty();
    if (group) {
      text += "  local state line\n  local -a commands=(\n";
      for (const Command& sub : command.commands) {
        text += "    " + shellQuoted(sub.name + ":" + zshText(sub.description)) + "\n";
      }
      text += "  )\n";
    }
    text += group ? "  _arguments -C" : "  _arguments";
    for (const Option& option : optionsOf(command, everywhere)) text += " \\\n    " + zshSpec(option);
    if (group) {
      text += " \\\n    '1:command:->command' '*::argument:->argument'\n  case $state in\n";
      text += "    command) _describe command commands ;;\n    argument)\n      case $words[1] in\n";
      for (const Command& sub : command.commands) {
        text += "        " + sub.name + ") " + zshFunction(path) + "_" + sub.name + " ;;\n";
      }
      text += "      esac ;;\n  esac";
    }
    text += "\n}\n";
  });
  return text + "\n_innersphere \"$@\"\n";
}

std::string fishCompletion(const Command& root, const std::vector<Option>& everywhere) {
  std::string text =
      "# fish completion of innersphere, written by: innersphere completion fish\n"
      "complete -c innersphere -f\n";
  visitAll(root, [&](const Command& command, const std::vector<std::string>& path) {
    const std::string condition = fishCondition(command, path);
    for (const Command& sub : command.commands) {
      text += "complete -c innersphere" + condition + " -a " + sub.name + " -d " + fishText(sub.description) +
              "\n";
    }
    for (const Option& option : optionsOf(command, everywhere)) text += fishLine(option, condition);
  });
  return text;
}

}  // namespace innersphere::tool

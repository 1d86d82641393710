#include "documentation.hpp"

namespace innersphere::tool {
namespace {

// Text in the language of man: its backslashes, dashes and leading dots mean themselves, and so do ends of
// lines.
std::string plain(const std::string& text) {
  std::string result;
  bool at_begin = true;
  for (const char c : text) {
    if (at_begin && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else if (c == '\n')
      result += "\n.br\n";
    else
      result += c;
    at_begin = c == '\n';
  }
  return result;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + plain(text) + "\\fR";
}

std::string entry(const Option& option) {
  std::string names;
  for (const std::string& name : option.spellings()) names += (names.empty() ? "" : ", ") + bold(name);
  if (option.isArgument())
    names = italic(option.name) + (option.repeated ? " ..." : "");
  else if (!option.isFlag())
    names += " " + italic(option.takes_file ? "FILE" : option.value_name);
  std::string text = plain(option.description) + ".";
  if (option.only_choices && !option.isArgument()) {
    std::string all;
    for (const std::string& choice : option.choices) all += (all.empty() ? "" : ", ") + bold(choice);
    text += " One of " + all + ".";
  }
  if (!option.default_text.empty()) text += " Default: " + plain(option.default_text) + ".";
  return ".TP\n" + names + "\n" + text + "\n";
}

std::string details(const Command& command) {
  std::string text;
  for (const Option& option : command.options) text += entry(option);
  for (const std::string& paragraph : {command.notes, command.exit_status}) {
    if (!paragraph.empty()) text += ".PP\n" + plain(paragraph) + "\n";
  }
  if (!command.examples.empty()) text += ".PP\n.EX\n";
  for (const std::string& example : command.examples) text += plain(example) + "\n";
  if (!command.examples.empty()) text += ".EE\n";
  return text;
}

std::string synopsis(const Command& command, const std::string& path) {
  std::string text = bold(path) + " [" + italic("OPTIONS") + "]";
  for (const Option& option : command.options) {
    if (option.isArgument()) text += " " + italic(option.name) + (option.repeated ? "..." : "");
  }
  return text;
}

void appendCommands(const Command& group, const std::string& path, std::string& text) {
  for (const Command& command : group.commands) {
    const std::string name = path + " " + command.name;
    if (command.commands.empty()) {
      text += ".SS " + synopsis(command, name) + "\n" + plain(command.description) + ".\n" + details(command);
    } else {
      appendCommands(command, name, text);
    }
  }
}

}  // namespace

std::string manualPage(const Command& root, const std::vector<Option>& everywhere,
                       const std::string& version) {
  std::string text = ".TH INNERSPHERE 1 \"\" \"InnerSphere " + version + "\" \"User Commands\"\n";
  text += ".SH NAME\n" + root.name + " \\- " + plain(root.description) + "\n";
  text += ".SH SYNOPSIS\n" + bold(root.name) + " " + italic("COMMAND") + " [" + italic("OPTIONS") + "]\n";
  text += ".SH DESCRIPTION\n" + plain(root.notes) + "\n";
  text += ".SH OPTIONS\n";
  for (const auto* options : {&everywhere, &root.options}) {
    for (const Option& option : *options) text += entry(option);
  }
  text += ".TP\n" + bold("-h") + ", " + bold("--help") + "\nPrint the help of a command.\n";
  text += ".SH COMMANDS\n";
  appendCommands(root, root.name, text);
  text += ".SH EXIT STATUS\n";
  text += plain(root.exit_status) + "\n";
  text += ".SH EXAMPLES\n.EX\n";
  for (const std::string& example : root.examples) text += plain(example) + "\n";
  return text + ".EE\n";
}

}  // namespace innersphere::tool

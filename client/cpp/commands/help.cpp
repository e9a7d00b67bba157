#include "client/cpp/commands/help.h"

#include <algorithm>
#include <iostream>
#include <memory>

#include "client/cpp/commands/help_topics.h"
#include "client/cpp/text/colour.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

constexpr std::chrono::milliseconds kSchemaTimeout(500);

/// Returns e.g. " Allowed: 0.1 to 1000 1/GPa (eq 33, alpha*)." from the server's table; empty if
/// the range is unknown.
std::string allowed_range(const Flag& flag, const v1::Schema* schema) {
  if (schema == nullptr || flag.constraint_field.empty()) return "";
  for (const v1::Constraint& row : schema->constraints()) {
    if (row.message() != flag.constraint_message || row.field() != flag.constraint_field) continue;
    const std::string unit = trade_unit_of_field(row.field());
    return " Allowed: " + significant(in_trade_unit(row.field(), row.minimum()), 6) + " to " +
           significant(in_trade_unit(row.field(), row.maximum()), 6) +
           (unit.empty() ? "" : " " + unit) +
           (row.equation().empty() ? "" : " (" + row.equation() + ")") + ".";
  }
  return "";
}

std::string flag_text(const Flag& flag, const v1::Schema* schema) {
  std::string names;
  for (const std::string& name : split(flag.names, ',')) {
    names += (names.empty() ? "" : ", ") + name;
  }
  if (flag.is_positional()) {
    names = flag.value_name;
  } else if (!flag.is_switch) {
    names += " <" + flag.value_name + ">";
  }
  return "  " + names + "\n" + wrapped(flag.description + allowed_range(flag, schema), 6);
}

std::string flags_text(const std::vector<const Flag*>& flags, const v1::Schema* schema) {
  std::string text;
  std::string group;
  for (const Flag* flag : flags) {
    if (flag->group != group) text += "\n" + heading(flag->group) + "\n";
    group = flag->group;
    text += flag_text(*flag, schema);
  }
  return text;
}

std::vector<const Flag*> visible_flags(const FlagList& list) {
  std::vector<const Flag*> flags;
  for (const Flag& flag : list.flags()) {
    if (!flag.is_hidden) flags.push_back(&flag);
  }
  return flags;
}

/// Returns the flags of the short help, in the order of the long one.
std::vector<const Flag*> main_flags_of(const Command& command) {
  std::vector<const Flag*> flags = visible_flags(command.flags);
  if (command.main_flags.empty()) return flags;
  std::erase_if(flags, [&](const Flag* flag) {
    const auto names = split(flag->names, ',');
    const bool is_main = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return std::find(command.main_flags.begin(), command.main_flags.end(), name) !=
             command.main_flags.end();
    });
    return !flag->is_positional() && !is_main;
  });
  return flags;
}

std::string group_of(const Command& command) {
  const std::size_t blank = command.path.find(' ');
  return blank == std::string::npos ? "" : command.path.substr(0, blank);
}

/// Returns one line per command, with the summaries in one column.
std::string lines_text(const std::vector<std::pair<std::string, std::string>>& lines) {
  std::size_t width = 0;
  for (const auto& [name, summary] : lines) width = std::max(width, name.size());
  std::string text;
  for (const auto& [name, summary] : lines) {
    text += "  " + name + std::string(width - name.size() + 2, ' ') + summary + "\n";
  }
  return text;
}

std::string topics_text() {
  std::vector<std::pair<std::string, std::string>> lines;
  for (const HelpTopic& topic : help_topics())
    lines.emplace_back("help " + topic.name, topic.summary);
  return lines_text(lines);
}

/// Returns the page of a topic, a command or a group.
std::string page(const std::vector<std::string>& words, const CommonOptions& options) {
  const std::vector<Command> commands = all_commands();
  if (words.empty()) return overview_text(commands);
  const std::string name = joined(words, " ");
  std::vector<std::string> known;
  for (const HelpTopic& topic : help_topics()) {
    if (topic.name == name) return topic.text;
    known.push_back(topic.name);
  }
  CommonOptions unused;
  FlagList common_flags;
  add_common_flags(common_flags, unused);
  for (const Command& command : commands) {
    if (command.path == name) {
      const auto schema = schema_for_help(command, options);
      return help_text(command, common_flags, schema ? &*schema : nullptr, HelpLength::kShort);
    }
    known.push_back(command.path);
    known.push_back(group_of(command));
  }
  std::string group = group_text(name, commands);
  if (!group.empty()) return group;
  const std::string meant = nearest(name, known);
  throw Failure(kExitUsage, "no help topic '" + printable(name) + "'" +
                                (meant.empty() ? "" : " (is " + meant + " meant?)") + "\nTopics\n" +
                                topics_text());
}

}  // namespace

std::optional<v1::Schema> schema_for_help(const Command& command, const CommonOptions& options) {
  const auto& flags = command.flags.flags();
  const bool needed = std::any_of(flags.begin(), flags.end(),
                                  [](const Flag& flag) { return !flag.constraint_field.empty(); });
  if (!needed) return std::nullopt;
  try {
    return options.connect(kSchemaTimeout).schema();
  } catch (const std::runtime_error&) {
    return std::nullopt;  // help works without a server
  }
}

std::string overview_text(const std::vector<Command>& commands) {
  std::vector<std::pair<std::string, std::string>> lines;
  std::string group;
  for (const Command& command : commands) {
    const std::string own = group_of(command);
    if (own.empty()) {
      lines.emplace_back(command.path, command.summary);
      group = own;
      continue;
    }
    const std::string verb = command.path.substr(own.size() + 1);
    if (own == group) {
      lines.back().second += ", " + verb;
    } else {
      lines.emplace_back(own, verb);
    }
    group = own;
  }
  return "tribodyn: what a gear oil costs in a hypoid axle, and why\n\n"
         "The server tribodynd computes losses at the tooth contact, without bearings, churning "
         "and\n"
         "seals; this program is its client.\n\n"
         "usage: tribodyn COMMAND [options]\n"
         "       tribodyn COMMAND --help       examples and the options that most calls need\n"
         "       tribodyn COMMAND --help-all   every option\n\n" +
         heading("Commands") + "\n" + lines_text(lines) + "\n" + heading("Topics") + "\n" +
         topics_text() + "\n" + heading("From three numbers to a curve") + "\n" +
         "  tribodyn lubricants create my-oil --kv40 103 --kv100 15.1 --density15 868 \\\n"
         "      --base-oil-class pao\n"
         "  tribodyn curve --lubricant my-oil --plot curve.svg\n"
         "\nExit codes: 0 done, 1 rejected or failed, 2 wrong usage, 3 no server, 130 "
         "interrupted.\n";
}

std::string group_text(const std::string& group, const std::vector<Command>& commands) {
  std::vector<std::pair<std::string, std::string>> lines;
  for (const Command& command : commands) {
    if (group_of(command) == group) lines.emplace_back(command.path, command.summary);
  }
  if (lines.empty()) return "";
  return heading("Commands") + "\n" + lines_text(lines) + "\n`tribodyn " + lines.front().first +
         " --help` and so on show their options.\n";
}

std::string help_text(const Command& command, const FlagList& common_flags,
                      const v1::Schema* schema, HelpLength length) {
  std::string text =
      "tribodyn " + command.path + ": " + command.summary + "\n\n" + heading("Examples") + "\n";
  for (const std::string& example : command.examples) text += "  " + example + "\n";
  text += "\nusage: tribodyn " + command.path;
  for (const Flag& flag : command.flags.flags()) {
    if (flag.is_positional()) text += " " + flag.value_name + (flag.is_repeatable ? "..." : "");
  }
  text += " [options]\n\n" + wrapped(command.about, 0);
  std::vector<const Flag*> flags = visible_flags(command.flags);
  const std::size_t own_flags = flags.size();
  if (length == HelpLength::kShort) {
    flags = main_flags_of(command);
  } else {
    std::vector<const Flag*> common = visible_flags(common_flags);
    std::erase_if(common, [&](const Flag* flag) { return replaces(command.flags, *flag); });
    flags.insert(flags.end(), common.begin(), common.end());
  }
  text += flags_text(flags, schema);
  const bool lacks_ranges =
      schema == nullptr && std::any_of(flags.begin(), flags.end(), [](const Flag* flag) {
        return !flag->constraint_field.empty();
      });
  if (lacks_ranges) {
    text +=
        "\nNo server answered. With a server, the help also shows allowed ranges (tribodyn "
        "schema).\n";
  }
  if (length == HelpLength::kShort) {
    const std::size_t more = own_flags - flags.size();
    text += "\n" + std::string(more == 0 ? "" : std::to_string(more) + " more options: ") +
            (more == 0 ? "Options of every command (--output, --server, ...): " : "") +
            "tribodyn " + command.path + " --help-all\n";
  }
  return text;
}

Command help_command() {
  const auto words = std::make_shared<std::vector<std::string>>();
  Command command{"help",
                  "a topic below or the help of a command",
                  "Prints a topic or the help of a command.",
                  {"tribodyn help units", "tribodyn help lubricants create"},
                  {},
                  {},
                  {}};
  command.flags.group("Arguments");
  Flag& flag = command.flags.texts("topic", "TOPIC", "A topic or the words of a command.",
                                   [words](const std::string& word) { words->push_back(word); });
  for (const HelpTopic& topic : help_topics()) flag.words.push_back(topic.name);
  command.run = [words](const CommonOptions& options) {
    std::cout << page(*words, options);
    return kExitOk;
  };
  return command;
}

}  // namespace tribodyn::client

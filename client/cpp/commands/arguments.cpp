#include "client/cpp/commands/arguments.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

using GivenTexts = std::map<const Flag*, std::vector<std::string>>;

/// CLI11 only splits the line into flags and texts. The texts are read later, so that all
/// complaints are found.
void add_flags(CLI::App& app, const FlagList& list, GivenTexts& given,
               const FlagList& replacements = {}) {
  for (const Flag& flag : list.flags()) {
    if (replaces(replacements, flag)) continue;
    if (flag.is_switch) {
      given[&flag].resize(1);  // common flags belong to the root and to the command
      app.add_flag(flag.names, given[&flag].front());
      continue;
    }
    CLI::Option* option = app.add_option_function<std::vector<std::string>>(
        flag.names, [&given, &flag](const std::vector<std::string>& texts) {
          auto& all = given[&flag];
          all.insert(all.end(), texts.begin(), texts.end());
        });
    option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    if (flag.is_positional() && flag.is_repeatable) continue;
    option->expected(1)->allow_extra_args(false);
  }
}

/// Adds the command; "jobs list" becomes a "list" below a "jobs" that several commands share.
CLI::App& add_command(CLI::App& root, const Command& command) {
  CLI::App* app = &root;
  for (const std::string& word : split(command.path, ' ')) {
    const auto below =
        app->get_subcommands([&](const CLI::App* each) { return each->get_name() == word; });
    app = below.empty() ? app->add_subcommand(word) : below.front();
    app->allow_extras();
    app->require_subcommand(0, 1);
  }
  return *app;
}

std::vector<std::string> names_of(const FlagList& list) {
  std::vector<std::string> names;
  for (const Flag& flag : list.flags()) {
    if (flag.is_positional()) continue;
    for (const std::string& name : split(flag.names, ',')) names.push_back(name);
  }
  return names;
}

/// Adds complaints about unknown words, with the nearest option or command.
void complain_of_extras(const CLI::App& root, const CLI::App& app, const Command* command,
                        const std::vector<Command>& commands, const FlagList& common_flags,
                        Complaints& complaints) {
  std::vector<std::string> options = names_of(common_flags);
  if (command != nullptr) {
    const auto own = names_of(command->flags);
    options.insert(options.end(), own.begin(), own.end());
  }
  std::vector<std::string> paths;
  paths.reserve(2 * commands.size());
  for (const Command& each : commands) paths.push_back(each.path);
  const std::string group = &app == &root ? "" : app.get_name() + " ";
  if (group.empty()) {
    for (const Command& each : commands) paths.push_back(each.path.substr(0, each.path.find(' ')));
  }

  bool follows_option = false;  // the value of an unknown option needs no complaint
  for (const std::string& extra : root.remaining(true)) {
    const std::string word = extra.substr(0, extra.find('='));
    const bool is_option = word.size() > 1 && word[0] == '-';
    if (extra != "--" && (is_option || !follows_option)) {
      const char* kind = is_option ? "option" : command != nullptr ? "argument" : "command";
      const std::string meant = is_option            ? nearest(word, options)
                                : command == nullptr ? nearest(group + word, paths)
                                                     : "";
      complaints.push_back(std::string("unknown ") + kind + " " + printable(word) +
                           (meant.empty() ? "" : " (is " + meant + " meant?)"));
    }
    follows_option = is_option && extra.find('=') == std::string::npos;
    if (!is_option && command == nullptr)
      break;  // the following words belong to the unknown command
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> parse_settings(std::istream& in,
                                                                const std::string& path,
                                                                Complaints& complaints) {
  std::vector<std::pair<std::string, std::string>> settings;
  try {
    for (const CLI::ConfigItem& item : CLI::ConfigINI().from_config(in)) {
      if (item.name == "++" || item.name == "--") continue;  // begin and end of a section
      settings.emplace_back(item.fullname(), item.inputs.empty() ? "" : item.inputs.front());
    }
  } catch (const CLI::Error& error) {
    complaints.push_back(path + ": " + error.what());
  }
  return settings;
}

Parsed parse_arguments(const std::vector<std::string>& arguments,
                       const std::vector<Command>& commands, const FlagList& common_flags) {
  CLI::App root;
  root.allow_extras();
  // Without this limit, a resource with the name of a command would be read as the command.
  root.require_subcommand(0, 1);
  root.set_help_all_flag("--help-all");
  bool version = false;
  root.add_flag("--version", version);
  GivenTexts given;
  add_flags(root, common_flags, given);
  std::map<const CLI::App*, const Command*> by_app;
  // CLI11 compares each flag with all others of its command: only where they may be read.
  const auto may_be_meant = [&](const Command& command) {
    const std::vector<std::string> words = split(command.path, ' ');
    return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
      return std::find(arguments.begin(), arguments.end(), word) != arguments.end();
    });
  };
  for (const Command& command : commands) {
    CLI::App& app = add_command(root, command);
    by_app[&app] = &command;
    if (!may_be_meant(command)) continue;
    add_flags(app, command.flags, given);
    add_flags(app, common_flags, given, command.flags);
  }

  Parsed parsed;
  try {
    // CLI11 requires the arguments in reverse order.
    root.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForAllHelp&) {
    parsed.wants_help = true;
    parsed.wants_all_help = true;
  } catch (const CLI::CallForHelp&) {
    parsed.wants_help = true;
  } catch (const CLI::ParseError& error) {
    parsed.complaints.push_back(error.what());
  }
  parsed.wants_version = version;
  const CLI::App* app = &root;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().back();
  const auto found = by_app.find(app);
  if (found != by_app.end()) {
    parsed.command = found->second;
  } else if (app != &root) {
    parsed.group = app->get_name();
  }
  if (parsed.wants_help || parsed.wants_version) return parsed;

  // A switch has a text only if it is given.
  std::erase_if(
      given, [](const auto& each) { return each.first->is_switch && each.second.front().empty(); });
  complain_of_extras(root, *app, parsed.command, commands, common_flags, parsed.complaints);
  if (parsed.command == nullptr) return parsed;
  const auto typed = [&](const Flag& flag) {
    const std::string name = flag.is_positional() ? flag.value_name : typed_name(flag, arguments);
    TypedFlag out{name, given[&flag], flag.bare_unit};
    const bool is_list_of_numbers = flag.is_repeatable && !flag.bare_unit.empty();
    if (is_list_of_numbers) out.texts = split(joined(out.texts, ","), ',');
    return out;
  };
  for (const FlagList* list : {&parsed.command->flags, &common_flags}) {
    for (const Flag& flag : list->flags()) {
      const auto texts = given.find(&flag);
      if (texts == given.end()) continue;
      if (!flag.is_file() && !std::all_of(texts->second.begin(), texts->second.end(), is_utf8)) {
        parsed.complaints.push_back(flag.first_name() + " is not UTF-8 text");
      } else {
        flag.read(texts->second, parsed.complaints);
        const bool sets_field = !flag.is_positional() || !flag.field.empty();
        if (sets_field) parsed.typed_flags[flag.field_name()] = typed(flag);
      }
    }
  }
  name_flags_as_typed(arguments, {&parsed.command->flags, &common_flags}, parsed.complaints);
  if (!parsed.command->check) return parsed;
  const std::size_t before = parsed.complaints.size();
  parsed.command->check(parsed.complaints);
  // A flag that is given and cannot be read is not missing.
  const auto is_given = [&given](const std::string& complaint) {
    const std::string flag = complaint.substr(0, complaint.find(" is missing"));
    return std::any_of(given.begin(), given.end(), [&flag](const auto& each) {
      const std::vector<std::string> names = split(each.first->names, ',');
      return std::find(names.begin(), names.end(), flag) != names.end();
    });
  };
  parsed.complaints.erase(
      std::remove_if(parsed.complaints.begin() + static_cast<std::ptrdiff_t>(before),
                     parsed.complaints.end(), is_given),
      parsed.complaints.end());
  return parsed;
}

}  // namespace tribodyn::client

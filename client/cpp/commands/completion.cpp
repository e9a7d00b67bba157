#include "client/cpp/commands/completion.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <set>

#include "client/cpp/commands/help_topics.h"
#include "client/cpp/resources/kind.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr std::chrono::milliseconds kCompletionTimeout(300);
constexpr int kMostNames = 1000;
constexpr char kFiles[] = "\\file";

constexpr char kBash[] = R"(# bash completion of tribodyn:  source <(tribodyn completion bash)
_tribodyn() {
  local line candidates
  # The words up to the cursor as they stand, with ':' and '=' inside them.
  read -ra line <<<"${COMP_LINE:0:COMP_POINT}"
  [[ "${COMP_LINE:0:COMP_POINT}" == *' ' ]] && line+=('')
  local word=${line[-1]}
  mapfile -t candidates < <("${line[0]}" __complete "${line[@]:1}" 2>/dev/null)
  if [ "${candidates[0]}" = '\file' ]; then
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "${word##*=}")
    return
  fi
  COMPREPLY=("${candidates[@]}")
  # readline replaces only what follows the last of its word breaks.
  COMPREPLY=("${COMPREPLY[@]#"${word%"${word##*[=:]}"}"}")
  [ ${#COMPREPLY[@]} -eq 1 ] && [[ ${COMPREPLY[0]} == *[=,] ]] && compopt -o nospace 2>/dev/null
  return 0
}
complete -F _tribodyn tribodyn
)";

constexpr char kZsh[] = R"(#compdef tribodyn
# zsh completion of tribodyn:  source <(tribodyn completion zsh), or as _tribodyn in a folder of fpath
_tribodyn() {
  local -a candidates
  candidates=("${(@f)$("${words[1]}" __complete "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  if [[ ${candidates[1]} == '\file' ]]; then
    _files
  else
    compadd -Q -- "${(@)candidates}"
  fi
}
if [[ $zsh_eval_context[-1] == loadautofunc ]]; then _tribodyn "$@"; else compdef _tribodyn tribodyn; fi
)";

std::vector<std::string> starting_with(const std::string& start,
                                       const std::vector<std::string>& words) {
  std::vector<std::string> result;
  for (const std::string& word : words) {
    if (word.rfind(start, 0) == 0) result.push_back(word);
  }
  return result;
}

/// Returns ids of a collection, at least those that begin with `start`; none after any error.
std::vector<std::string> names_of(const std::string& collection, const std::string& start,
                                  const CommonOptions& options) {
  std::vector<std::string> names;
  try {
    Connection connection = options.connect(kCompletionTimeout);
    if (collection == "simulations") {
      for (const auto& simulation : connection.list_simulations({.limit = 50}).resources) {
        names.push_back(resource_id(simulation.name()));
      }
    }
    if (collection == "campaigns") {
      for (const auto& campaign : connection.list_campaigns({.limit = 50}).resources) {
        names.push_back(resource_id(campaign.name()));
      }
    }
    for (const ResourceKind& kind : resource_kinds()) {
      if (kind.collection != collection) continue;
      ListOptions list;
      list.limit = kMostNames;
      list.basic = true;
      // The filter limits a long list to names that may match.
      if (!start.empty() && start.find_first_of("\"\\") == std::string::npos) {
        list.filter = "name:\"" + start + "\"";
      }
      for (const auto& resource : kind.calls->list(connection, list).resources) {
        names.push_back(resource_id(text_field(*resource, "name")));
      }
    }
  } catch (const std::exception&) {
    names.clear();
  }
  return names;
}

/// Returns values of a flag; in a list with commas it completes the last one.
std::vector<std::string> values_of(const Flag& flag, const std::string& start,
                                   const CommonOptions& options) {
  if (flag.is_file()) return {kFiles};
  const std::size_t comma = flag.is_repeatable ? start.rfind(',') : std::string::npos;
  const std::string head = comma == std::string::npos ? "" : start.substr(0, comma + 1);
  std::vector<std::string> words = flag.words;
  if (!flag.collection.empty()) {
    words = names_of(flag.collection, start.substr(head.size()), options);
  }
  for (std::string& word : words) word.insert(0, head);
  return starting_with(start, words);
}

const Flag* find_flag(const std::string& name, const std::vector<const FlagList*>& lists) {
  for (const FlagList* list : lists) {
    for (const Flag& flag : list->flags()) {
      const auto names = split(flag.names, ',');
      if (!flag.is_positional() && std::find(names.begin(), names.end(), name) != names.end()) {
        return &flag;
      }
    }
  }
  return nullptr;
}

/// The meaning of the words before the last one.
struct Line {
  std::string path;  ///< of the command, as far as it is known
  const Command* command = nullptr;
  const Flag* awaiting = nullptr;  ///< the flag whose value is next
  int arguments = 0;               ///< number of positional arguments so far
};

Line read_line(const std::vector<std::string>& words, const std::vector<Command>& commands,
               const FlagList& common_flags) {
  Line line;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const std::string& word = words[i];
    if (line.awaiting != nullptr) {
      line.awaiting = nullptr;
      continue;
    }
    std::vector<const FlagList*> lists;
    if (line.command != nullptr) lists.push_back(&line.command->flags);
    lists.push_back(&common_flags);
    if (!word.empty() && word[0] == '-') {
      const Flag* flag = find_flag(word, lists);
      if (flag != nullptr && !flag->is_switch) line.awaiting = flag;
      continue;
    }
    if (line.command != nullptr) {
      ++line.arguments;
      continue;
    }
    line.path += (line.path.empty() ? "" : " ") + word;
    for (const Command& command : commands) {
      if (command.path == line.path) line.command = &command;
    }
  }
  return line;
}

std::vector<std::string> next_words(const Line& line, const std::vector<Command>& commands) {
  const std::string start = line.path.empty() ? "" : line.path + " ";
  std::set<std::string> words;
  for (const Command& command : commands) {
    if (command.path.rfind(start, 0) != 0) continue;
    const std::string rest = command.path.substr(start.size());
    words.insert(rest.substr(0, rest.find(' ')));
  }
  return {words.begin(), words.end()};
}

std::vector<std::string> flag_names(const std::vector<const FlagList*>& lists) {
  std::vector<std::string> names = {"--help", "--help-all"};
  for (const FlagList* list : lists) {
    for (const Flag& flag : list->flags()) {
      if (flag.is_positional() || flag.is_hidden) continue;
      for (const std::string& name : split(flag.names, ',')) {
        const bool is_new = std::find(names.begin(), names.end(), name) == names.end();
        if (name.rfind("--", 0) == 0 && is_new) names.push_back(name);
      }
    }
  }
  return names;
}

const Flag* positional(const Command& command, int index) {
  for (const Flag& flag : command.flags.flags()) {
    if (!flag.is_positional()) continue;
    if (index == 0 || flag.is_repeatable) return &flag;
    --index;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> completions(const std::vector<std::string>& words,
                                     const std::vector<Command>& commands,
                                     const FlagList& common_flags, const CommonOptions& options) {
  if (words.empty()) return {};
  const std::string& last = words.back();
  const Line line = read_line(words, commands, common_flags);
  if (line.awaiting != nullptr) return values_of(*line.awaiting, last, options);
  std::vector<const FlagList*> lists;
  if (line.command != nullptr) lists.push_back(&line.command->flags);
  lists.push_back(&common_flags);
  if (!last.empty() && last[0] == '-') {
    const std::size_t mark = last.find('=');
    if (mark == std::string::npos) return starting_with(last, flag_names(lists));
    const Flag* flag = find_flag(last.substr(0, mark), lists);
    if (flag == nullptr || flag->is_switch) return {};
    auto values = values_of(*flag, last.substr(mark + 1), options);
    for (std::string& value : values) {
      if (value != kFiles) value.insert(0, last.substr(0, mark + 1));
    }
    return values;
  }
  if (line.command == nullptr) return starting_with(last, next_words(line, commands));
  const Flag* flag = positional(*line.command, line.arguments);
  return flag == nullptr ? std::vector<std::string>() : values_of(*flag, last, options);
}

Command completion_command() {
  const auto shell = std::make_shared<int>(-1);
  Command command{"completion",
                  "a script that completes commands, flags and names in your shell",
                  "Prints a completion script. Names of resources come from the server, if the "
                  "server answers at once.",
                  {"tribodyn completion bash", "tribodyn completion zsh"},
                  {},
                  {},
                  {}};
  command.flags.group("Arguments");
  command.flags.choice("shell", {"bash", "zsh"},
                       "bash: source <(tribodyn completion bash) in ~/.bashrc; zsh: source "
                       "<(tribodyn completion zsh) in "
                       "~/.zshrc, after compinit.",
                       [shell](int index) { *shell = index; });
  command.check = [shell](Complaints& complaints) {
    if (*shell < 0) complaints.emplace_back("name the shell: bash or zsh");
  };
  command.run = [shell](const CommonOptions&) {
    std::cout << (*shell == 0 ? kBash : kZsh);
    return kExitOk;
  };
  return command;
}

}  // namespace tribodyn::client

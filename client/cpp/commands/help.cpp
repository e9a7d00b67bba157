#include "client/cpp/commands/help.h"

#include <algorithm>
#include <numeric>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

std::string flag_text(const Flag& flag) {
  std::string names;
  for (const std::string& name : split(flag.names, ',')) {
    names += (names.empty() ? "" : ", ") + name;
  }
  if (flag.is_positional()) {
    names = flag.value_name;
  } else if (!flag.is_switch) {
    names += " <" + flag.value_name + ">";
  }
  return "  " + names + "\n" + wrapped(flag.description, 6);
}

std::string flags_text(const FlagList& list) {
  std::string text;
  std::string group;
  for (const Flag& flag : list.flags()) {
    if (flag.group != group) text += "\n" + flag.group + "\n";
    group = flag.group;
    text += flag_text(flag);
  }
  return text;
}

int edit_distance(const std::string& a, const std::string& b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row.back();
}

}  // namespace

std::string overview_text(const std::vector<Command>& commands) {
  std::string text =
      "tribodyn: what a gear oil costs in a hypoid axle, and why\n\n"
      "Asks a tribodynd server for mesh (conjunctional) losses; bearings, churning and seals are\n"
      "not in them.\n\n"
      "usage: tribodyn COMMAND [options]\n"
      "       tribodyn COMMAND --help     units, legal ranges and defaults of every option\n\n"
      "Commands\n";
  std::size_t width = 0;
  for (const Command& command : commands) width = std::max(width, command.path.size());
  for (const Command& command : commands) {
    text += "  " + command.path + std::string(width - command.path.size() + 2, ' ') +
            command.summary + "\n";
  }
  text += "\nExamples\n";
  for (const Command& command : commands) text += "  " + command.examples.front() + "\n";
  return text +
         "\nExit codes: 0 done, 1 refused or failed, 2 wrong usage, 3 no server, 130 "
         "interrupted.\n";
}

std::string help_text(const Command& command, const FlagList& common_flags) {
  std::string usage = "usage: tribodyn " + command.path;
  for (const Flag& flag : command.flags.flags()) {
    if (flag.is_positional()) usage += " " + flag.value_name + (flag.is_repeatable ? "..." : "");
  }
  std::string text = "tribodyn " + command.path + ": " + command.summary + "\n\n" + usage +
                     " [options]\n\n" + wrapped(command.about, 0) + flags_text(command.flags) +
                     flags_text(common_flags) + "\nExamples\n";
  for (const std::string& example : command.examples) text += "  " + example + "\n";
  return text;
}

std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  std::string best;
  int least = static_cast<int>(std::max<std::size_t>(2, word.size() / 3)) + 1;
  for (const std::string& candidate : known) {
    const int distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace tribodyn::client

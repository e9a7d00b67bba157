#include "client/cpp/commands/settings.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "client/cpp/commands/arguments.h"
#include "client/cpp/text/nearest.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr char kPathVariable[] = "TRIBODYN_CONFIG";

std::string environment(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value != nullptr ? value : "";
}

/// Returns "timeout-seconds" for "--timeout-seconds".
std::string key_of(const Flag& flag) { return flag.first_name().substr(2); }

std::string variable_of(const Flag& flag) {
  std::string name = "TRIBODYN_" + key_of(flag);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
    return c == '-' ? '_' : static_cast<char>(std::toupper(c));
  });
  return name;
}

void read_one(const Flag& flag, const std::string& text, const std::string& where,
              Complaints& complaints) {
  Complaints own;
  flag.read({text}, own);
  for (const std::string& complaint : own) complaints.push_back(where + ": " + complaint);
}

void apply_file(const FlagList& common_flags, Complaints& complaints) {
  const std::string path = settings_path();
  std::ifstream file(path);
  if (path.empty() || !file) {
    if (!environment(kPathVariable).empty()) complaints.push_back("cannot read " + path);
    return;
  }
  std::vector<std::string> keys;
  for (const Flag& flag : common_flags.flags()) {
    if (!flag.is_switch) keys.push_back(key_of(flag));
  }
  for (const auto& [key, value] : parse_settings(file, path, complaints)) {
    const auto& flags = common_flags.flags();
    const auto flag = std::find_if(flags.begin(), flags.end(), [&, name = key](const Flag& each) {
      return !each.is_switch && key_of(each) == name;
    });
    if (flag == flags.end()) {
      const std::string meant = nearest(key, keys);
      complaints.push_back(path + ": unknown key " + printable(key) +
                           (meant.empty() ? "" : " (is " + meant + " meant?)"));
    } else {
      read_one(*flag, value, path, complaints);
    }
  }
}

}  // namespace

std::string settings_path() {
  if (std::string path = environment(kPathVariable); !path.empty()) return path;
  if (const std::string folder = environment("XDG_CONFIG_HOME"); !folder.empty()) {
    return folder + "/tribodyn/config";
  }
  const std::string home = environment("HOME");
  return home.empty() ? "" : home + "/.config/tribodyn/config";
}

void apply_settings(const FlagList& common_flags, Complaints& complaints) {
  apply_file(common_flags, complaints);
  for (const Flag& flag : common_flags.flags()) {
    if (flag.is_switch) continue;
    const std::string value = environment(variable_of(flag));
    if (!value.empty()) read_one(flag, value, variable_of(flag), complaints);
  }
}

}  // namespace tribodyn::client

#include "client/cpp/commands/result_files.h"

#include <algorithm>
#include <cctype>

#include "client/cpp/text/output.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

/// Returns e.g. ".png" for "pictures/curve.PNG"; empty if the name has no extension.
std::string lower_extension(const std::string& path) {
  const std::string name = path.substr(path.rfind('/') + 1);
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot == 0) return "";
  std::string extension = name.substr(dot);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void check_writable(const std::string& flag, const std::string& path, Complaints& complaints) {
  const std::string why = why_not_writable(path);
  if (!why.empty()) {
    complaints.push_back(flag + ": cannot write " + printable(path) + ": " + why);
  }
}

}  // namespace

void add_plot_flag(FlagList& flags, const std::string& description, std::string& path) {
  Flag& flag = add_result_file_flag(flags, "--plot", "FILE.svg", description, path);
  flag.read = [read = flag.read](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) {
      const std::string extension = lower_extension(text);
      if (extension.empty() || extension == ".svg") continue;
      const std::string stem = text.substr(0, text.size() - extension.size());
      complaints.push_back("--plot: '" + printable(text) + "' must end in .svg. Write --plot " +
                           printable(stem) + ".svg; `rsvg-convert " + printable(stem) + ".svg -o " +
                           printable(stem) + ".png` makes a PNG, -f pdf a PDF");
      return;
    }
    read(texts, complaints);
  };
}

Flag& add_result_file_flag(FlagList& flags, const std::string& name, const std::string& value_name,
                           const std::string& description, std::string& path) {
  Flag& flag =
      flags.text(name, value_name, description, [&path](const std::string& text) { path = text; });
  flag.read = [name, read = flag.read](const std::vector<std::string>& texts,
                                       Complaints& complaints) {
    read(texts, complaints);
    for (const std::string& text : texts) {
      if (!text.empty()) check_writable(name, text, complaints);
    }
  };
  return flag;
}

std::map<std::string, std::string> lubricant_titles(const std::vector<v1::Simulation>& simulations,
                                                    Connection& connection) {
  std::map<std::string, std::string> titles;
  for (const v1::Simulation& simulation : simulations) {
    try {
      titles[simulation.lubricant()] =
          connection.get<v1::Lubricant>(simulation.lubricant()).display_name();
    } catch (const ServiceError&) {
      continue;
    }
  }
  return titles;
}

}  // namespace tribodyn::client

#include <iostream>
#include <memory>

#include "client/cpp/commands/command.h"
#include "client/cpp/report/fluid_difference.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {

Command diff_command() {
  struct DiffFlags {
    std::string a, b;
    bool all = false;
    bool exit_code = false;
  };
  const auto flags = std::make_shared<DiffFlags>();
  Command command{
      "diff",
      "the differences between two lubricants",
      "Compares two lubricants, or two revisions of one: viscosities, index, grade and every "
      "parameter with its unit, its origin and the relative difference (B - A)/|A|. Only what "
      "differs is shown, unless --all.",
      {"tribodyn diff paper-fluid-1 paper-fluid-2",
       "tribodyn diff my-oil@1 my-oil --all --output csv"},
      {},
      {},
      {}};
  command.flags.group("Arguments");
  command.flags
      .text("a", "A",
            "A lubricant, e.g. paper-fluid-1, or a revision of a lubricant, e.g. my-oil@2.",
            [flags](const std::string& text) { flags->a = text; })
      .collection = "lubricants";
  command.flags
      .text("b", "B", "Another lubricant or revision.",
            [flags](const std::string& text) { flags->b = text; })
      .collection = "lubricants";
  command.flags.group("Options");
  command.flags.toggle("--all", "Show equal values too.", [flags] { flags->all = true; });
  command.flags.toggle("--exit-code", "Exit with code 4 if they differ.",
                       [flags] { flags->exit_code = true; });
  command.check = [flags](Complaints& complaints) {
    if (flags->b.empty()) complaints.emplace_back("give two lubricants: tribodyn diff A B");
  };
  command.run = [flags](const CommonOptions& options) {
    Connection connection = options.connect();
    const auto a = connection.get<v1::Lubricant>(resource_name("lubricants", flags->a));
    const auto b = connection.get<v1::Lubricant>(resource_name("lubricants", flags->b));
    const FluidDifference difference = fluid_difference(a, b, flags->all, options.output_format);
    std::cout << difference.text;
    return difference.differs && flags->exit_code ? kExitDiffers : kExitOk;
  };
  return command;
}

}  // namespace tribodyn::client

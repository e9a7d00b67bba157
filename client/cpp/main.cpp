#include <algorithm>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "client/cpp/commands/arguments.h"
#include "client/cpp/commands/completion.h"
#include "client/cpp/commands/help.h"
#include "client/cpp/commands/settings.h"
#include "client/cpp/failure.h"
#include "client/cpp/text/colour.h"

namespace tribodyn::client {
namespace {

/// Prints the complaints; the first `of_settings` of them are about the configuration.
int complain(const Parsed& parsed, std::size_t of_settings) {
  std::string command;
  if (parsed.command != nullptr) command = " " + parsed.command->path;
  if (parsed.command == nullptr && !parsed.group.empty()) command = " " + parsed.group;
  for (const std::string& complaint : parsed.complaints) {
    std::cerr << alarm("tribodyn" + command + ":") << " " << complaint << "\n";
  }
  if (of_settings > 0) std::cerr << "See tribodyn help configuration\n";
  if (parsed.complaints.size() > of_settings) {
    std::cerr << "See tribodyn" << command << " --help\n";
  }
  return kExitUsage;
}

std::string help_of(const Parsed& parsed, const std::vector<Command>& commands,
                    const FlagList& common_flags, const CommonOptions& options) {
  if (parsed.command != nullptr) {
    const auto schema = schema_for_help(*parsed.command, options);
    return help_text(*parsed.command, common_flags, schema ? &*schema : nullptr,
                     parsed.wants_all_help ? HelpLength::kAll : HelpLength::kShort);
  }
  return parsed.group.empty() ? overview_text(commands) : group_text(parsed.group, commands);
}

/// Returns the failure with the help topic that explains it.
Failure with_topic(const ServiceError& error, const Failure& failure) {
  const auto& violations = error.violations();
  const bool is_of_list =
      std::any_of(violations.begin(), violations.end(), [](const FieldViolation& violation) {
        return violation.field == "filter" || violation.field == "order_by";
      });
  if (!is_of_list) return failure;
  return {failure.exit_code(), std::string(failure.what()) + "\nSee tribodyn help filters"};
}

int run(const std::vector<std::string>& arguments) {
  CommonOptions options;
  FlagList common_flags;
  add_common_flags(common_flags, options);
  const std::vector<Command> commands = all_commands();
  Complaints of_settings;
  apply_settings(common_flags, of_settings);
  if (!arguments.empty() && arguments.front() == kCompleteWord) {
    const std::vector<std::string> words(arguments.begin() + 1, arguments.end());
    for (const std::string& word : completions(words, commands, common_flags, options)) {
      std::cout << word << "\n";
    }
    return kExitOk;
  }
  Parsed parsed = parse_arguments(arguments, commands, common_flags);
  set_colours(options.colour);
  if (parsed.wants_version) {
    std::cout << "tribodyn " << TRIBODYN_VERSION << "\n";
    return kExitOk;
  }
  if (parsed.wants_help) {
    std::cout << help_of(parsed, commands, common_flags, options);
    return kExitOk;
  }
  parsed.complaints.insert(parsed.complaints.begin(), of_settings.begin(), of_settings.end());
  if (!(options.timeout_seconds > 0 && options.timeout_seconds <= 86400)) {
    parsed.complaints.emplace_back("--timeout-seconds must be above 0 and at most 86400");
  }
  if (!parsed.complaints.empty()) return complain(parsed, of_settings.size());
  if (parsed.command == nullptr) {
    std::cerr << help_of(parsed, commands, common_flags, options);
    return kExitUsage;
  }
  options.typed_flags = parsed.typed_flags;
  try {
    return parsed.command->run(options);
  } catch (const ServiceError& error) {
    throw with_topic(error, Failure(with_flag_names(error, options.typed_flags)));
  }
}

int end(const Failure& failure) {
  std::cout.flush();
  std::cerr << alarm("tribodyn:") << " " << failure.what() << "\n";
  return failure.exit_code();
}

}  // namespace
}  // namespace tribodyn::client

int main(int argc, char** argv) {
  using namespace tribodyn::client;
  try {
    const int exit_code = run(std::vector<std::string>(argv + 1, argv + argc));
    if (!std::cout.flush()) throw Failure(kExitFailed, "cannot write the result");
    return exit_code;
  } catch (const Failure& failure) {
    return end(failure);
  } catch (const ServiceError& error) {
    return end(Failure(error));
  } catch (const std::exception& error) {
    return end(Failure(kExitFailed, error.what()));
  }
}

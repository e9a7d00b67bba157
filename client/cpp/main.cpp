#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "client/cpp/commands/arguments.h"
#include "client/cpp/commands/help.h"
#include "client/cpp/failure.h"

namespace tribodyn::client {
namespace {

int complain(const Parsed& parsed) {
  const std::string command = parsed.command != nullptr ? " " + parsed.command->path : "";
  for (const std::string& complaint : parsed.complaints) {
    std::cerr << "tribodyn" << command << ": " << complaint << "\n";
  }
  std::cerr << "See tribodyn" << command << " --help\n";
  return kExitUsage;
}

int run(const std::vector<std::string>& arguments) {
  CommonOptions options;
  FlagList common_flags;
  add_common_flags(common_flags, options);
  const std::vector<Command> commands = all_commands();
  Parsed parsed = parse_arguments(arguments, commands, common_flags);
  if (parsed.wants_version) {
    std::cout << "tribodyn " << TRIBODYN_VERSION << "\n";
    return kExitOk;
  }
  if (parsed.wants_help) {
    std::cout << (parsed.command != nullptr ? help_text(*parsed.command, common_flags)
                                            : overview_text(commands));
    return kExitOk;
  }
  if (!(options.timeout_seconds > 0 && options.timeout_seconds <= 86400)) {
    parsed.complaints.emplace_back("--timeout-seconds must be above 0 and at most 86400");
  }
  if (!parsed.complaints.empty()) return complain(parsed);
  if (parsed.command == nullptr) {
    std::cerr << overview_text(commands);
    return kExitUsage;
  }
  return parsed.command->run(options);
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
    std::cout.flush();
    std::cerr << "tribodyn: " << failure.what() << "\n";
    return failure.exit_code();
  } catch (const std::exception& error) {
    std::cerr << "tribodyn: " << error.what() << "\n";
    return kExitFailed;
  }
}

#include <iostream>
#include <memory>

#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/commands/result_files.h"
#include "client/cpp/report/roughness_report.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

struct RoughnessFlags {
  TableFiles tables;
  v1::EvaluateProfilesRequest request;
  std::string plot_path;
};

int run_roughness(const RoughnessFlags& flags, const CommonOptions& options) {
  v1::EvaluateProfilesRequest request = flags.request;
  for (const TableFiles::Profile& profile : flags.tables.profiles) {
    *request.add_profiles() = profile_message(profile);
  }
  request.set_levelling(flags.tables.levelling);
  request.set_short_wave_cut_off_metres(flags.tables.short_wave_cut_off_metres);
  request.set_long_wave_cut_off_metres(flags.tables.long_wave_cut_off_metres);
  request.set_eq46_square_root_of_sum(flags.tables.eq46_as_published);
  Connection connection = options.connect();
  v1::EvaluateProfilesResponse answer;
  try {
    answer = connection.evaluate_profiles(request);
  } catch (const ServiceError& error) {
    throw with_file_names(error, flags.tables);
  }
  std::cout << roughness_text(answer, options.output_format);
  if (!flags.plot_path.empty()) write_file(flags.plot_path, roughness_plot(answer));
  return kExitOk;
}

}  // namespace

Command roughness_command() {
  const auto flags = std::make_shared<RoughnessFlags>();
  Command command{
      "roughness",
      "surface parameters of measured profiles, by the sampling interval",
      "Computes the surface that measured profiles of the flanks make: moments (eq 45), averaged "
      "over the profiles of a flank and direction, both directions (eq 46) and both flanks (eq 47) "
      "joined, and the parameters of Greenwood and Tripp (eq 48) with the uncertainty by the "
      "spread "
      "of the profiles. Then the same from every second height, every third, and so on: asperities "
      "depend on the sampling interval. Nothing is stored; `tribodyn surfaces create --profile` "
      "makes a surface.",
      {"tribodyn roughness pinion,axial,heel.csv pinion,axial,middle.csv pinion,axial,toe.csv "
       "--lambda-s 2.5 --lambda-c 0.8",
       "tribodyn roughness profile.csv --sampling-steps 1,2,4,8 --plot roughness.svg"},
      {},
      {},
      {}};
  FlagList& list = command.flags;
  list.group("Arguments");
  add_profile_flags(list, "profiles", flags->tables);
  Flag& steps =
      list.raw("--sampling-steps", "N,...",
               "Sampling intervals in sample spacings, rising. Default: 1, 2, 3, 4, 6, 8, "
               "12 and so on, while 50 heights of each profile are left.");
  steps.is_repeatable = true;
  steps.read = [flags](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) {
      for (const std::string& word : split(text, ',')) {
        const bool is_number = !word.empty() && word.size() < 9 &&
                               word.find_first_not_of("0123456789") == std::string::npos;
        if (is_number) {
          flags->request.add_sampling_steps(std::stoi(word));
        } else {
          complaints.push_back("--sampling-steps: '" + printable(word) + "' is not a whole number");
        }
      }
    }
  };
  list.group("Files");
  add_plot_flag(list, "Also draw the parameters against the sampling interval as SVG.",
                flags->plot_path);
  command.check = [flags](Complaints& complaints) {
    if (flags->tables.profiles.empty()) {
      complaints.emplace_back("give a profile: tribodyn roughness profile.csv");
    }
  };
  command.main_flags = {"profiles", "--lambda-s", "--lambda-c", "--sampling-steps", "--plot"};
  command.run = [flags](const CommonOptions& options) { return run_roughness(*flags, options); };
  return command;
}

}  // namespace tribodyn::client

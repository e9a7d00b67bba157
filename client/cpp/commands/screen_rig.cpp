#include "client/cpp/commands/screen_rig.h"

#include <algorithm>
#include <cstdint>

#include "client/cpp/commands/candidate_flags.h"
#include "client/cpp/report/candidate_decisions.h"
#include "client/cpp/report/rig_rows.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr char kSmooth[] = "surfaces/smooth";

/// Returns true if the surfaces of all conditions roll without sliding: no traction.
bool rolls_only(const v1::CampaignRig& rig) {
  const auto& slides = rig.grid().slide_roll_ratios_percent();
  return std::all_of(slides.begin(), slides.end(), [](double each) { return each == 0; }) &&
         std::all_of(rig.conditions().begin(), rig.conditions().end(),
                     [](const auto& each) { return each.slide_roll_ratio_percent() == 0; });
}

}  // namespace

std::vector<std::pair<const char*, bool>> ScreenRigFlags::stated() const {
  return {{"--rig", !machine.empty()},
          {"--load", !given.loads.empty()},
          {"--pressure", !given.mean_pressures.empty()},
          {"--entrainment-speed", !given.speeds.empty()},
          {"--srr", !given.slide_roll_ratios.empty()},
          {"--temperature", !given.temperatures.empty()},
          {"--radius", radius_x.has_value()},
          {"--radius-y-metres", radius_y.has_value()},
          {"--roughness", roughness.has_value()},
          {"--disc", !disc.empty()}};
}

void add_screen_rig_flags(FlagList& list, ScreenRigFlags& flags) {
  list.group("Rig in place of the axle (lists: every combination is a condition)");
  static const std::vector<std::string> kMachines{"traction", "film", "stribeck"};
  list.choice(
      "--rig", kMachines,
      "Runs the candidates on the rig of this command, with its defaults, and ranks them by "
      "least traction, on the rig for films by the thickest film. --surface smooth: without "
      "roughness.",
      [&flags](int index) { flags.machine = kMachines[static_cast<std::size_t>(index)]; });
  const char* usual = "that of the rig";
  add_rig_setting_flags(
      list,
      {"--entrainment-speed-metres-per-second,--entrainment-speed", usual, usual, usual, usual},
      flags.given);
  list.number("--radius-x-metres,--radius", {"m", "1e-5 to 1e4", usual},
              "Radius of the ball, e.g. 12.7mm; of a ring: along the motion",
              [&flags](double value) { flags.radius_x = value; });
  list.number("--radius-y-metres", {"m", "1e-5 to 1e4", "0"},
              "Radius across the motion; 0: that along the motion",
              [&flags](double value) { flags.radius_y = value; });
  list.choice("--disc", {"steel", "glass"},
              "Material of the disc; the ball is of steel. Default: that of the rig.",
              [&flags](int index) { flags.disc = index == 0 ? "steel" : "glass"; });
  list.number("--composite-rms-height-metres,--roughness", {"m", "1e-10 to 0.01", usual},
              "Height sigma_G of the specimens in place of that of the surface, e.g. 20nm; 0: that "
              "of the surface",
              [&flags](double value) { flags.roughness = value; });
  for (const bool wants_most : {false, true}) {
    const std::string name = wants_most ? "--most" : "--least";
    Flag& flag = list.raw(name, "FIGURE",
                          wants_most ? "Ranks by a figure of the rig of which more is better."
                                     : "Ranks by a figure of the rig of which less is better, as "
                                       "of `campaigns rank`, e.g. contact_temperature_kelvin:max.");
    flag.field = "objective";
    flag.read = [&flags, wants_most, name](const std::vector<std::string>& texts,
                                           Complaints& complaints) {
      v1::CandidateObjective& objective = flags.objectives.emplace_back();
      objective.set_wants_most(wants_most);
      read_candidate_figure(name, texts.back(), *objective.mutable_figure(), complaints);
    };
  }
}

void check_screen_rig_flags(const ScreenRigFlags& flags, Complaints& complaints) {
  if (flags.machine.empty()) {
    for (const auto& [flag, is_given] : flags.stated()) {
      if (is_given) {
        complaints.push_back(std::string(flag) +
                             " applies to a rig: --rig traction, film or "
                             "stribeck is missing");
      }
    }
  }
  if (!flags.given.loads.empty() && !flags.given.mean_pressures.empty()) {
    complaints.emplace_back("--load and --pressure exclude each other");
  }
  if (flags.objectives.size() > 1) complaints.emplace_back("give one --least or --most");
}

v1::EvaluateRigRequest rig_of_screen(const ScreenRigFlags& flags,
                                     const v1::EvaluatePointsRequest& request) {
  RigMachine machine = rig_machine(flags.machine);
  v1::EvaluateRigRequest out = machine.request;
  out.set_lubricant(request.lubricant());
  *out.mutable_model_options() = request.model_options();
  if (!request.surface().empty()) {
    out.set_surface(request.surface() == kSmooth ? "" : request.surface());
    out.set_composite_rms_height_metres(0);
  }
  if (flags.roughness) out.set_composite_rms_height_metres(*flags.roughness);
  if (flags.radius_x) out.set_radius_x_metres(*flags.radius_x);
  if (flags.radius_y) out.set_radius_y_metres(*flags.radius_y);
  if (!flags.disc.empty()) set_disc(flags.disc, out);
  for (const RigAxis& axis : rig_axes()) {
    const std::vector<double>& given = flags.given.*axis.values;
    if (!given.empty()) machine.settings.*axis.values = given;
  }
  if (!machine.settings.mean_pressures.empty()) machine.settings.loads.clear();
  *out.mutable_grid() = grid_of(machine.settings);
  return out;
}

void set_rig(const v1::EvaluateRigRequest& rig, v1::Campaign& campaign) {
  v1::CampaignRig& out = *campaign.mutable_rig();
  out.set_composite_rms_height_metres(rig.composite_rms_height_metres());
  out.set_radius_x_metres(rig.radius_x_metres());
  out.set_radius_y_metres(rig.radius_y_metres());
  if (rig.has_body_1()) *out.mutable_body_1() = rig.body_1();
  if (rig.has_body_2()) *out.mutable_body_2() = rig.body_2();
  *out.mutable_grid() = rig.grid();
}

v1::CandidateObjective usual_objective(const v1::Campaign& campaign) {
  const bool is_film = campaign.has_rig() && rolls_only(campaign.rig());
  v1::CandidateObjective out;
  out.set_wants_most(is_film);
  out.mutable_figure()->set_column(is_film ? "central_film_thickness_metres"
                                           : usual_column(campaign));
  return out;
}

void read_rig_rows(Connection& connection, const v1::Campaign& campaign,
                   const std::function<void(const std::vector<std::string>&)>& write) {
  CampaignRowsOptions options;
  options.columns = {"candidate"};
  for (const v1::CandidateColumn& each : campaign.candidate_columns()) {
    options.columns.push_back(each.path());
  }
  const google::protobuf::RepeatedPtrField<std::string>* names = nullptr;
  for (const v1::CandidateAttribute& each : campaign.candidate_attributes()) {
    if (each.name() == "name" && !each.texts().empty()) names = &each.texts();
    if (!each.values().empty()) options.columns.push_back(each.name());
  }
  options.columns.insert(options.columns.end(),
                         {"load_newtons", "entrainment_speed_metres_per_second",
                          "slide_roll_ratio_percent", "supply_temperature_celsius"});
  for (const std::string& each : rig_columns()) options.columns.push_back(each);
  options.columns.insert(options.columns.end(), {"verdict_withheld", "refusal_number"});
  connection.stream_campaign(
      campaign.name(), options,
      [&](const v1::HistorySchema& schema) {
        std::vector<std::string> header{"name"};
        for (const auto& each : schema.columns()) header.push_back(each.name());
        header.back() = "refusal";
        write(header);
      },
      [&](const HistoryRows& rows) {
        for (std::size_t i = 0; i < rows.columns.front().size(); ++i) {
          const int candidate = static_cast<int>(rows.columns.front()[i]);
          std::vector<std::string> cells{names == nullptr ? std::to_string(candidate)
                                                          : names->Get(candidate)};
          for (const std::vector<double>& column : rows.columns) {
            cells.push_back(shortest(column[i]));
          }
          const int number = static_cast<int>(rows.columns.back()[i]);
          cells.back() = number < 0    ? "not computed"
                         : number == 0 ? ""
                                       : printable(campaign.refusals(number - 1).message());
          write(cells);
        }
      });
}

}  // namespace tribodyn::client

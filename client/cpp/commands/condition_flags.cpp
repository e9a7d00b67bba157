#include "client/cpp/commands/condition_flags.h"

#include <algorithm>

#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr double kUsualSpeed = 60;  // [km/h]

void check_count(const char* flag, std::size_t weights, std::size_t values, const std::string& noun,
                 Complaints& complaints) {
  if (weights == 0 || weights == values) return;
  const auto counted = [](std::size_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  };
  complaints.push_back(std::string(flag) + ": " + counted(weights, "weight") + " of " +
                       counted(values, noun) + "; give one for each " + noun);
}

}  // namespace

std::vector<v1::PointCondition> ConditionFlags::conditions() const {
  const std::vector<double> all_speeds = speeds.empty() ? std::vector{kUsualSpeed} : speeds;
  std::vector<v1::PointCondition> out;
  for (std::size_t j = 0; j < std::max<std::size_t>(sumps.size(), 1); ++j) {
    for (const double speed : all_speeds) {
      v1::PointCondition& condition = out.emplace_back(common);
      condition.set_speed_kilometres_per_hour(speed);
      if (!sumps.empty()) condition.set_sump_temperature_celsius(sumps[j]);
    }
  }
  return out;
}

double ConditionFlags::weight(std::size_t speed, std::size_t sump) const {
  return (speed_weights.empty() ? 1 : speed_weights[speed]) *
         (sump_weights.empty() ? 1 : sump_weights[sump]);
}

std::vector<double> ConditionFlags::weights() const {
  std::vector<double> out;
  for (std::size_t j = 0; j < std::max<std::size_t>(sumps.size(), 1); ++j) {
    for (std::size_t i = 0; i < std::max<std::size_t>(speeds.size(), 1); ++i) {
      out.push_back(weight(i, j));
    }
  }
  return out;
}

void add_condition_flags(FlagList& list, SumpCount sumps, ConditionFlags& flags) {
  const bool several = sumps == SumpCount::kSeveral;
  list.group(several ? "Conditions (every speed at every sump temperature)" : "Conditions");
  list.numbers("--speed-kilometres-per-hour,--speed,--speeds", {"km/h", "0.1 to 400", "60"},
               "Vehicle speeds separated by commas",
               [&flags](double value) { flags.speeds.push_back(value); });
  if (several) {
    list.numbers("--sump-temperature-celsius,--sump,--sumps", {"C", "-70 to 200", "40"},
                 "Temperatures of the oil bath separated by commas",
                 [&flags](double value) { flags.sumps.push_back(value); });
  } else {
    Flag& sump = list.numbers("--sump-temperature-celsius,--sump", {"C", "-70 to 200", "40"},
                              "Temperature of the oil bath",
                              [&flags](double value) { flags.sumps.assign(1, value); });
    sump.is_repeatable = false;
    sump.read = [read = sump.read](const std::vector<std::string>& texts, Complaints& complaints) {
      const bool has_comma = std::any_of(texts.begin(), texts.end(), [](const std::string& text) {
        return text.find(',') != std::string::npos;
      });
      if (!has_comma) return read(texts, complaints);
      complaints.push_back("--sump: '" + printable(joined(texts, " ")) +
                           "' has a comma; give one temperature, with a decimal point");
    };
  }
  list.numbers("--condition-weights,--weights", {"-", "1e-9 to 1e9", "equal"},
               "Weights of the speeds in the mean, one for each",
               [&flags](double value) { flags.speed_weights.push_back(value); });
  if (several) {
    list.numbers("--sump-weights", {"-", "1e-9 to 1e9", "equal"},
                 "Weights of the temperatures of the oil bath in the mean, one for each",
                 [&flags](double value) { flags.sump_weights.push_back(value); });
  }
  list.number("--ascent-angle-degrees,--ascent", {"degrees", "-45 to 45", "0"},
              "Road slope, also in percent: 6%",
              [&flags](double value) { flags.common.set_ascent_angle_degrees(value); });
  list.number("--inlet-temperature-rise-kelvin", {"K", "0 to 300", "20"},
              "Temperature rise from the oil bath to the inlet of the contact (eq 14)",
              [&flags](double value) { flags.common.set_inlet_temperature_rise_kelvin(value); });
}

void check_weight_counts(const ConditionFlags& flags, std::size_t speeds, std::size_t sumps,
                         Complaints& complaints) {
  check_count("--weights", flags.speed_weights.size(), speeds, "speed", complaints);
  check_count("--sump-weights", flags.sump_weights.size(), sumps, "sump temperature", complaints);
}

void check_condition_flags(const ConditionFlags& flags, Complaints& complaints) {
  check_weight_counts(flags, std::max<std::size_t>(flags.speeds.size(), 1),
                      std::max<std::size_t>(flags.sumps.size(), 1), complaints);
}

}  // namespace tribodyn::client

#include "client/cpp/commands/design_flags.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "client/cpp/resources/candidate_table.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

constexpr std::size_t kMostFactors = 30;  ///< parameters that differ in one call of EvaluatePoints

const FieldDescriptor* parameter_of(const std::string& word, std::string& wrong) {
  const FieldDescriptor* field = find_candidate_parameter(word, wrong);
  const std::vector<const FieldDescriptor*> known = candidate_parameters();
  if (field != nullptr && std::find(known.begin(), known.end(), field) == known.end()) {
    wrong = "'" + printable(word) + "' is no parameter of candidates";
    return nullptr;
  }
  return field;
}

/// Reads "PARAMETER=LOW:HIGH", e.g. "pressure-viscosity=14/GPa:18/GPa".
void read_range(const std::string& flag, const std::string& text, bool is_logarithmic,
                std::vector<DesignFactor>& out, Complaints& complaints) {
  const std::string start = flag + ": '" + printable(text) + "' ";
  const std::size_t equals = text.find('='), colon = text.rfind(':');
  if (equals == std::string::npos || colon == std::string::npos || colon < equals) {
    complaints.push_back(start + "is not PARAMETER=LOW:HIGH, e.g. " +
                         "pressure-viscosity=14/GPa:18/GPa");
    return;
  }
  std::string wrong;
  const FieldDescriptor* field = parameter_of(text.substr(0, equals), wrong);
  if (field == nullptr) {
    complaints.push_back(flag + ": " + wrong);
    return;
  }
  const std::string unit = unit_of_field(field->name());
  const std::string bare = unit.empty() ? "" : trade_unit_of_field(field->name());
  const bool is_temperature = is_temperature_field(field->name());
  const auto low =
      read_quantity(text.substr(equals + 1, colon - equals - 1), unit, bare, is_temperature, wrong);
  const auto high =
      low ? read_quantity(text.substr(colon + 1), unit, bare, is_temperature, wrong) : std::nullopt;
  if (!low || !high) {
    complaints.push_back(start + wrong);
  } else if (!(*low < *high)) {
    complaints.push_back(start + "must have a LOW below its HIGH");
  } else if (is_logarithmic && !(*low > 0)) {
    complaints.push_back(start + "must have a LOW above 0");
  } else if (std::any_of(out.begin(), out.end(),
                         [field](const auto& each) { return each.field == field; })) {
    complaints.push_back(start + "is a second range of the same parameter");
  } else {
    out.push_back({field, {*low, *high, is_logarithmic}});
  }
}

void add_range_flag(FlagList& list, const std::string& name, const std::string& description,
                    bool is_logarithmic, DesignFlags& flags) {
  Flag& flag = list.raw(name, "PARAMETER=LOW:HIGH", description);
  flag.is_repeatable = true;
  flag.read = [name, is_logarithmic, &flags](const std::vector<std::string>& texts,
                                             Complaints& complaints) {
    flags.has_ranges = true;
    for (const std::string& text : texts) {
      read_range(name, text, is_logarithmic, flags.factors, complaints);
    }
  };
}

double grid_size(const DesignFlags& flags) {
  return std::pow(flags.levels_or_default(), static_cast<double>(flags.factors.size()));
}

}  // namespace

void add_range_flags(FlagList& list, DesignFlags& flags) {
  add_range_flag(list, "--range",
                 "A parameter of lubricant or surface and its range, e.g. "
                 "pressure-viscosity=14/GPa:18/GPa; repeatable.",
                 false, flags);
  add_range_flag(list, "--log-range", "The same, with equal ratios instead of equal differences.",
                 true, flags);
}

void add_method_flags(FlagList& list, int most, DesignFlags& flags) {
  list.choice("--method", {"sobol", "latin-hypercube", "grid"},
              "sobol: Sobol's sequence with a random digital shift, best with 64, 128, 256, ... "
              "candidates; latin-hypercube: each parameter once in each of as many parts of its "
              "range as there are candidates; grid: every combination of --levels. Default: sobol.",
              [&flags](int index) {
                flags.has_method = true;
                flags.method = static_cast<DesignMethod>(index);
              });
  list.whole_number("--count", {"candidates", "1 to " + std::to_string(most), "64"}, "Candidates",
                    [&flags](int value) {
                      flags.has_method = true;
                      flags.count = value;
                    });
  list.whole_number("--levels", {"levels", "1 to 1000", "3"}, "Levels of each parameter in a grid",
                    [&flags](int value) {
                      flags.has_method = true;
                      flags.levels = value;
                    });
  list.whole_number("--seed", {"-", "0 to 2147483647", "1"},
                    "Seed of the random numbers. Equal seeds give equal tables, now and with later "
                    "versions of tribodyn.",
                    [&flags](int value) {
                      flags.has_method = true;
                      flags.seed = value;
                    });
}

void check_design_flags(const DesignFlags& flags, int most, Complaints& complaints) {
  if (flags.factors.size() > kMostFactors) {
    complaints.push_back(std::to_string(flags.factors.size()) + " ranges; allowed: at most " +
                         std::to_string(kMostFactors));
  }
  if (flags.count < 0 || flags.count > most) {
    complaints.push_back("--count = " + std::to_string(flags.count) + "; allowed: 1 to " +
                         std::to_string(most));
  }
  if (flags.levels < 0 || flags.levels > 1000) {
    complaints.push_back("--levels = " + std::to_string(flags.levels) + "; allowed: 1 to 1000");
  }
  if (flags.seed < 0) complaints.emplace_back("--seed must be at least 0");
  const bool is_grid = flags.method == DesignMethod::kGrid;
  if (is_grid && flags.count != 0) {
    complaints.emplace_back("--count does not apply to a grid; --levels decides its size");
  }
  if (!is_grid && flags.levels != 0) complaints.emplace_back("--levels applies to --method grid");
  if (is_grid && grid_size(flags) > most) {
    complaints.push_back("the grid has " + significant(grid_size(flags), 3) +
                         " candidates; allowed: at most " + std::to_string(most) +
                         ". Use fewer --levels, or --method sobol");
  }
}

v1::CandidateDesign design_message(const DesignFlags& flags) {
  v1::CandidateDesign out;
  const bool is_grid = flags.method == DesignMethod::kGrid;
  out.set_method(is_grid ? v1::CandidateDesign::GRID
                         : (flags.method == DesignMethod::kSobol
                                ? v1::CandidateDesign::SOBOL
                                : v1::CandidateDesign::LATIN_HYPERCUBE));
  if (!is_grid) {
    out.set_count(flags.count_or_default());
    out.set_seed(flags.seed);
  }
  for (const DesignFactor& each : flags.factors) {
    v1::DesignFactor& factor = *out.add_factors();
    factor.set_parameter(CandidateParameter{each.field, {}}.path());
    factor.set_minimum(each.range.least);
    factor.set_maximum(each.range.most);
    if (each.range.is_logarithmic) factor.set_scale(v1::DesignFactor::LOGARITHMIC);
    if (is_grid) factor.set_levels(flags.levels_or_default());
  }
  return out;
}

}  // namespace tribodyn::client

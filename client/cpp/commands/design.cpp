#include "core/decisions/design.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "client/cpp/commands/command.h"
#include "client/cpp/resources/candidate_table.h"
#include "client/cpp/resources/edits.h"
#include "client/cpp/resources/kind.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"
#include "core/uncertainty/drawn_value.h"
#include "core/uncertainty/normal_draws.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

constexpr int kMostDesigned = 1'000'000;
constexpr int kMostFactors = 30;  ///< parameters that differ in one call of EvaluatePoints

/// One parameter of a design.
struct DesignFactor {
  const FieldDescriptor* field;
  FactorRange range;  ///< in the unit of the field
};

enum class DesignMethod { kSobol, kLatinHypercube, kGrid };

struct DesignFlags {
  std::vector<DesignFactor> factors;
  bool has_ranges = false;  ///< also of ranges that cannot be read
  DesignMethod method = DesignMethod::kSobol;
  int count = 0;
  int levels = 0;
  int seed = 1;
  std::string like;
  std::string surface;
};

const FieldDescriptor* parameter_of(const std::string& word, std::string& wrong) {
  const FieldDescriptor* field = find_parameter(kind_of(*v1::Surface::descriptor()), word, wrong);
  if (field == nullptr) {
    field = find_parameter(kind_of(*v1::Lubricant::descriptor()), word, wrong);
  }
  const std::vector<const FieldDescriptor*> known = candidate_parameters();
  if (field != nullptr && std::find(known.begin(), known.end(), field) == known.end()) {
    wrong = "is no parameter of candidates";
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
    complaints.push_back(start + wrong);
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

void add_design_flags(FlagList& list, DesignFlags& flags) {
  list.group("Ranges");
  add_range_flag(list, "--range",
                 "A parameter of lubricant or surface and its range, e.g. "
                 "pressure-viscosity=14/GPa:18/GPa; repeatable.",
                 false, flags);
  add_range_flag(list, "--log-range", "The same, with equal ratios instead of equal differences.",
                 true, flags);
  Flag& like = list.text(
      "--uncertainties-of", "LUBRICANT",
      "Instead of ranges: draw the parameters of this lubricant that have a standard uncertainty, "
      "as "
      "log-normal about their values. Laws fitted to viscosities and densities stay as they are.",
      [&flags](const std::string& name) { flags.like = resource_name("lubricants", name); });
  like.collection = "lubricants";
  list.text("--surface", "NAME", "With --uncertainties-of: draw those of this surface too.",
            [&flags](const std::string& name) { flags.surface = resource_name("surfaces", name); })
      .collection = "surfaces";
  list.group("Design");
  list.choice("--method", {"sobol", "latin-hypercube", "grid"},
              "sobol: Sobol's sequence with a random digital shift, best with 64, 128, 256, ... "
              "candidates; latin-hypercube: each parameter once in each of as many parts of its "
              "range as there are candidates; grid: every combination of --levels. Default: sobol.",
              [&flags](int index) { flags.method = static_cast<DesignMethod>(index); });
  list.whole_number("--count", {"candidates", "1 to 1000000", "64"}, "Candidates",
                    [&flags](int value) { flags.count = value; });
  list.whole_number("--levels", {"levels", "1 to 1000", "3"}, "Levels of each parameter in a grid",
                    [&flags](int value) { flags.levels = value; });
  list.whole_number("--seed", {"-", "0 to 2147483647", "1"},
                    "Seed of the random numbers. Equal seeds give equal tables, now and with later "
                    "versions of tribodyn.",
                    [&flags](int value) { flags.seed = value; });
}

double grid_size(const DesignFlags& flags) {
  return std::pow(flags.levels == 0 ? 3 : flags.levels, static_cast<double>(flags.factors.size()));
}

void check_design_flags(const DesignFlags& flags, Complaints& complaints) {
  if (flags.has_ranges != flags.like.empty()) {
    complaints.emplace_back(
        "give ranges (--range PARAMETER=LOW:HIGH), or else --uncertainties-of LUBRICANT");
  }
  if (flags.factors.size() > kMostFactors) {
    complaints.push_back(std::to_string(flags.factors.size()) + " ranges; allowed: at most " +
                         std::to_string(kMostFactors));
  }
  if (!flags.surface.empty() && flags.like.empty()) {
    complaints.emplace_back("--surface applies to --uncertainties-of, which is missing");
  }
  if (flags.count < 0 || flags.count > kMostDesigned) {
    complaints.push_back("--count = " + std::to_string(flags.count) + "; allowed: 1 to 1000000");
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
  if (is_grid && !flags.like.empty()) {
    complaints.emplace_back("--uncertainties-of needs --method sobol or latin-hypercube");
  }
  if (is_grid && grid_size(flags) > kMostDesigned) {
    complaints.push_back("the grid has " + significant(grid_size(flags), 3) +
                         " candidates; allowed: at most 1000000. Use fewer --levels, or --method "
                         "sobol");
  }
}

/// A column of the table: its header and its values.
struct DesignColumn {
  std::string header;
  std::vector<double> values;
};

Eigen::MatrixXd shares_of(const DesignFlags& flags, int factors) {
  const auto seed = static_cast<std::uint64_t>(flags.seed);
  const int count = flags.count == 0 ? 64 : flags.count;
  switch (flags.method) {
    case DesignMethod::kSobol:
      return sobol_design(count, factors, seed);
    case DesignMethod::kLatinHypercube:
      return latin_hypercube_design(count, factors, seed);
    case DesignMethod::kGrid:
      break;
  }
  return grid_design(
      std::vector<int>(static_cast<std::size_t>(factors), flags.levels == 0 ? 3 : flags.levels));
}

template <class ValueAt>
std::vector<double> column_values(const Eigen::MatrixXd& shares, std::size_t factor,
                                  const ValueAt& value_at) {
  std::vector<double> out;
  for (Eigen::Index i = 0; i < shares.rows(); ++i) {
    out.push_back(value_at(shares(i, static_cast<Eigen::Index>(factor))));
  }
  return out;
}

std::vector<DesignColumn> columns_of_ranges(const DesignFlags& flags) {
  const Eigen::MatrixXd shares = shares_of(flags, static_cast<int>(flags.factors.size()));
  std::vector<DesignColumn> out;
  for (std::size_t k = 0; k < flags.factors.size(); ++k) {
    const DesignFactor& factor = flags.factors[k];
    out.push_back({factor.field->name(), column_values(shares, k, [&](double share) {
                     return value_in_range(factor.range, share);
                   })});
  }
  return out;
}

std::vector<DesignColumn> columns_of_uncertainties(const DesignFlags& flags,
                                                   const CommonOptions& options) {
  Connection connection = options.connect();
  CandidateBase base;
  base.lubricant = connection.get<v1::Lubricant>(flags.like);
  if (!flags.surface.empty()) base.surface = connection.get<v1::Surface>(flags.surface);
  std::vector<std::pair<const FieldDescriptor*, double>> uncertain;
  for (const FieldDescriptor* field : candidate_parameters()) {
    const double uncertainty = stated_uncertainty(base, *field);
    if (uncertainty > 0) uncertain.emplace_back(field, uncertainty);
  }
  if (uncertain.empty()) {
    throw Failure(kExitFailed, printable(flags.like) +
                                   " states no standard uncertainty of a parameter. Set one with "
                                   "tribodyn lubricants update --uncertainty, or give ranges.");
  }
  const Eigen::MatrixXd shares = shares_of(flags, static_cast<int>(uncertain.size()));
  std::vector<DesignColumn> out;
  for (std::size_t k = 0; k < uncertain.size(); ++k) {
    const auto [field, uncertainty] = uncertain[k];
    const double value = base_value(base, *field);
    out.push_back({field->name(), column_values(shares, k, [&, spread = uncertainty](double share) {
                     return drawn_value(value, spread, normal_quantile(share));
                   })});
  }
  return out;
}

int run_design(const DesignFlags& flags, const CommonOptions& options) {
  const std::vector<DesignColumn> columns =
      flags.like.empty() ? columns_of_ranges(flags) : columns_of_uncertainties(flags, options);
  std::vector<std::string> cells = {"candidate"};
  for (const DesignColumn& each : columns) cells.push_back(each.header);
  std::cout << csv_line(cells);
  for (std::size_t i = 0; i < columns.front().values.size(); ++i) {
    cells = {std::to_string(i + 1)};
    for (const DesignColumn& each : columns) cells.push_back(shortest(each.values[i]));
    std::cout << csv_line(cells);
  }
  return kExitOk;
}

}  // namespace

Command design_command() {
  const auto flags = std::make_shared<DesignFlags>();
  Command command{
      "design",
      "candidates for a screening, from ranges or from uncertainties",
      "Prints a table of candidates that fill ranges of parameters evenly, or that spread as the "
      "standard uncertainties of a lubricant say, as CSV for `tribodyn screen`. Ranges need no "
      "server.",
      {"tribodyn design --range pressure-viscosity=14/GPa:18/GPa --range "
       "asperity-friction-coefficient=0.05:0.12 --count 256",
       "tribodyn design --range relaxation-time=0.2us:0.6us --method grid --levels 5",
       "tribodyn design --uncertainties-of my-oil --method latin-hypercube --count 200"},
      {},
      {},
      {}};
  add_design_flags(command.flags, *flags);
  command.check = [flags](Complaints& complaints) { check_design_flags(*flags, complaints); };
  command.run = [flags](const CommonOptions& options) { return run_design(*flags, options); };
  return command;
}

}  // namespace tribodyn::client

#include "core/decisions/design.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "client/cpp/commands/command.h"
#include "client/cpp/commands/design_flags.h"
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

/// A design, or the names of the resources whose uncertainties it follows.
struct DesignOptions {
  DesignFlags design;
  std::string like;
  std::string surface;
};

void add_design_options(FlagList& list, DesignOptions& flags) {
  list.group("Ranges");
  add_range_flags(list, flags.design);
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
  add_method_flags(list, kMostDesigned, flags.design);
}

void check_design_options(const DesignOptions& flags, Complaints& complaints) {
  if (flags.design.has_ranges != flags.like.empty()) {
    complaints.emplace_back(
        "give ranges (--range PARAMETER=LOW:HIGH), or else --uncertainties-of LUBRICANT");
  }
  if (!flags.surface.empty() && flags.like.empty()) {
    complaints.emplace_back("--surface applies to --uncertainties-of, which is missing");
  }
  check_design_flags(flags.design, kMostDesigned, complaints);
  if (flags.design.method == DesignMethod::kGrid && !flags.like.empty()) {
    complaints.emplace_back("--uncertainties-of needs --method sobol or latin-hypercube");
  }
}

/// A column of the table: its header and its values.
struct DesignColumn {
  std::string header;
  std::vector<double> values;
};

Eigen::MatrixXd shares_of(const DesignFlags& flags, int factors) {
  const auto seed = static_cast<std::uint64_t>(flags.seed);
  const int count = flags.count_or_default();
  switch (flags.method) {
    case DesignMethod::kSobol:
      return sobol_design(count, factors, seed);
    case DesignMethod::kLatinHypercube:
      return latin_hypercube_design(count, factors, seed);
    case DesignMethod::kGrid:
      break;
  }
  return grid_design(
      std::vector<int>(static_cast<std::size_t>(factors), flags.levels_or_default()));
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
    out.push_back(
        {CandidateParameter{factor.field, {}}.header(), column_values(shares, k, [&](double share) {
           return value_in_range(factor.range, share);
         })});
  }
  return out;
}

std::vector<DesignColumn> columns_of_uncertainties(const DesignOptions& flags,
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
  const Eigen::MatrixXd shares = shares_of(flags.design, static_cast<int>(uncertain.size()));
  std::vector<DesignColumn> out;
  for (std::size_t k = 0; k < uncertain.size(); ++k) {
    const auto [field, uncertainty] = uncertain[k];
    const double value = base_value(base, *field);
    out.push_back({CandidateParameter{field, {}}.header(),
                   column_values(shares, k, [&, spread = uncertainty](double share) {
                     return drawn_value(value, spread, normal_quantile(share));
                   })});
  }
  return out;
}

int run_design(const DesignOptions& flags, const CommonOptions& options) {
  const std::vector<DesignColumn> columns = flags.like.empty()
                                                ? columns_of_ranges(flags.design)
                                                : columns_of_uncertainties(flags, options);
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
  const auto flags = std::make_shared<DesignOptions>();
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
  add_design_options(command.flags, *flags);
  command.check = [flags](Complaints& complaints) { check_design_options(*flags, complaints); };
  command.run = [flags](const CommonOptions& options) { return run_design(*flags, options); };
  return command;
}

}  // namespace tribodyn::client

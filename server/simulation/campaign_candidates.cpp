#include "server/simulation/campaign_candidates.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "core/decisions/design.h"
#include "core/uncertainty/drawn_value.h"
#include "core/uncertainty/normal_draws.h"
#include "proto/field_behavior.h"
#include "server/contract/check_message.h"
#include "server/contract/constraints.h"
#include "server/resources/provenance.h"
#include "server/simulation/campaign_rig.h"
#include "server/simulation/candidate_uncertainty.h"
#include "server/simulation/point_evaluation.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;

constexpr int kMaximumFactors = 30;                                 // as of candidate_columns
constexpr std::int64_t kLargestSeed = (std::int64_t{1} << 53) - 1;  // JSON keeps it exactly
constexpr char kUncertaintySuffix[] = ".uncertainty";

/// A factor of a design.
struct PlacedFactor {
  std::string parameter;
  const FieldDescriptor* field;
  std::optional<FactorRange> range;  ///< empty: by the standard uncertainty
  double median = 0;                 ///< without a range: in the unit of the field
  double standard_uncertainty = 0;
  int levels = 0;

  double value(double share) const {
    if (range) return value_in_range(*range, share);
    return drawn_value(median, standard_uncertainty, normal_quantile(share));
  }
};

/// Returns the base of a design; the smooth specimens of a rig have no surface. Adds violations if
/// it does not exist.
SimulationInputs base_of_design(const v1::Campaign& request, const ResourceLookup& lookup,
                                Violations& violations) {
  SimulationInputs out;
  const std::string surface = request.surface().empty() ? kDefaultSurface : request.surface();
  if (auto found = find_resource<v1::Lubricant>(lookup, request.lubricant(), kLubricants,
                                                "lubricant", violations)) {
    out.lubricant = found->resource;
  }
  if (has_smooth_specimens(request)) return out;
  if (auto found = find_resource<v1::Surface>(lookup, surface, kSurfaces, "surface", violations)) {
    out.surface = found->resource;
  }
  return out;
}

/// Reads the range of a factor. Adds violations.
void read_range(const v1::DesignFactor& stated, const std::string& path, PlacedFactor& out,
                Violations& violations) {
  out.range = FactorRange{stated.minimum(), stated.maximum(),
                          stated.scale() == v1::DesignFactor::LOGARITHMIC};
  const Constraint* row = find_constraint(*out.field);
  bool is_right = true;
  for (const auto& [name, value] :
       {std::pair("minimum", stated.minimum()), std::pair("maximum", stated.maximum())}) {
    if (row == nullptr || row->allows(value)) continue;
    is_right = false;
    violations.add(path + "." + name, out_of_range_text(*row, value));
  }
  if (!is_right) return;
  const auto ends = [&] {
    return fmt::format("{} to {}", number_text(stated.minimum()), number_text(stated.maximum()));
  };
  if (!(stated.minimum() < stated.maximum())) {
    violations.add(path + ".maximum", "the range is {}; allowed: a maximum above the minimum",
                   ends());
  } else if (out.range->is_logarithmic && !(stated.minimum() > 0)) {
    violations.add(path + ".minimum",
                   "the range is {}; allowed with LOGARITHMIC: a minimum above 0", ends());
  }
}

/// Sets the median and the standard uncertainty. Adds a violation if the base states none.
void read_spread(const SimulationInputs& base, const v1::Campaign& request, const std::string& path,
                 PlacedFactor& out, Violations& violations) {
  const bool has_surface = base.surface || has_smooth_specimens(request);
  if (!base.lubricant || !has_surface) return;  // complained about already
  const std::optional<double> value = base_value(*out.field, base);
  out.standard_uncertainty = value ? stated_by_base(out.parameter, *out.field, base) : 0;
  out.median = value.value_or(0);
  if (out.standard_uncertainty > 0) return;
  const bool is_surface = out.field->containing_type() == v1::Surface::descriptor();
  const std::string& owner = is_surface ? request.surface() : request.lubricant();
  violations.add(path,
                 "{} has no range, and {} states no standard uncertainty of it; allowed: "
                 "minimum and maximum{}",
                 out.parameter, owner.empty() ? kDefaultSurface : owner,
                 errs_with_a_law(*out.field)
                     ? " (parameters of the laws of viscosity and density err together)"
                     : "");
}

std::vector<PlacedFactor> stated_factors(const v1::Campaign& request, const SimulationInputs& base,
                                         Violations& violations) {
  const v1::CandidateDesign& design = request.candidate_design();
  const bool is_grid = design.method() == v1::CandidateDesign::GRID;
  std::vector<PlacedFactor> out;
  std::set<std::string> known;
  for (int i = 0; i < design.factors_size(); ++i) {
    const v1::DesignFactor& each = design.factors(i);
    const std::string path = fmt::format("candidate_design.factors[{}]", i);
    PlacedFactor factor{each.parameter(), find_candidate_parameter(each.parameter()), {}};
    factor.levels = each.levels();
    if (factor.field == nullptr) {
      violations.add(path + ".parameter", unknown_parameter_text(each.parameter()));
      continue;
    }
    if (std::string text = no_effect_text(request, each.parameter()); !text.empty()) {
      violations.add(path + ".parameter", std::move(text));
      continue;
    }
    if (!known.insert(each.parameter()).second) {
      violations.add(path + ".parameter", "\"{}\" is listed twice; allowed: once",
                     each.parameter());
    }
    if (each.has_minimum() != each.has_maximum()) {
      violations.add(path + (each.has_minimum() ? ".maximum" : ".minimum"),
                     "not set; allowed: both ends of the range, or neither");
    } else if (each.has_minimum()) {
      read_range(each, path, factor, violations);
    } else if (is_grid) {
      violations.add(path + ".minimum",
                     "not set; allowed in a GRID: a range. A distribution by the standard "
                     "uncertainty needs LATIN_HYPERCUBE or SOBOL");
    } else {
      read_spread(base, request, path, factor, violations);
    }
    if (is_grid ? each.levels() < 1 || each.levels() > kMaximumCandidates : each.levels() != 0) {
      violations.add(
          path + ".levels",
          is_grid ? fmt::format("levels = {}; allowed: 1 to {}", each.levels(), kMaximumCandidates)
                  : fmt::format("levels = {}; allowed: 0, as only a GRID has levels; count states "
                                "the number of candidates",
                                each.levels()));
    }
    out.push_back(std::move(factor));
  }
  return out;
}

/// Returns the parameters whose standard uncertainty the base states.
std::vector<PlacedFactor> uncertain_factors(const v1::Campaign& request,
                                            const SimulationInputs& base, Violations& violations) {
  std::vector<PlacedFactor> out;
  if (!base.lubricant || (!base.surface && !has_smooth_specimens(request))) return out;
  for (const std::string& parameter : candidate_parameter_names()) {
    PlacedFactor factor{parameter, find_candidate_parameter(parameter), {}};
    if (factor.field == nullptr) continue;  // unreachable: each listed name has a field
    const std::optional<double> value = base_value(*factor.field, base);
    if (!value) continue;
    factor.median = *value;
    factor.standard_uncertainty = stated_by_base(parameter, *factor.field, base);
    if (factor.standard_uncertainty > 0) out.push_back(std::move(factor));
  }
  if (out.empty()) {
    violations.add("candidate_design.factors",
                   "not set, and {} and its surface state no standard uncertainty of a "
                   "parameter; allowed: factors with ranges",
                   request.lubricant());
  }
  return out;
}

/// Returns the number of candidates. Adds violations.
int design_size(const v1::CandidateDesign& design, const std::vector<PlacedFactor>& factors,
                Violations& violations) {
  const std::string path = "candidate_design.";
  if (design.method() != v1::CandidateDesign::GRID) {
    if (design.count() < 1 || design.count() > kMaximumCandidates) {
      violations.add(path + "count", "count = {}; allowed: 1 to {}", design.count(),
                     kMaximumCandidates);
    }
    return design.count();
  }
  if (design.count() != 0) {
    violations.add(path + "count",
                   "count = {}; allowed: 0, as the levels of a GRID state its number of candidates",
                   design.count());
  }
  if (design.seed() != 0) {
    violations.add(path + "seed", "seed = {}; allowed: 0, as a GRID has no random numbers",
                   design.seed());
  }
  double size = 1;
  for (const PlacedFactor& each : factors) size *= std::max(1, each.levels);
  if (size <= kMaximumCandidates) return static_cast<int>(size);
  violations.add(path + "factors",
                 "the grid has {} candidates; allowed: at most {}. State fewer levels, or SOBOL",
                 number_text(size), kMaximumCandidates);
  return 0;
}

Eigen::MatrixXd shares_of(const v1::CandidateDesign& design, int count,
                          const std::vector<PlacedFactor>& factors) {
  const auto seed = static_cast<std::uint64_t>(design.seed());
  const int columns = static_cast<int>(factors.size());
  if (design.method() == v1::CandidateDesign::SOBOL) return sobol_design(count, columns, seed);
  if (design.method() == v1::CandidateDesign::LATIN_HYPERCUBE) {
    return latin_hypercube_design(count, columns, seed);
  }
  std::vector<int> levels;
  for (const PlacedFactor& each : factors) levels.push_back(each.levels);
  return grid_design(levels);
}

/// Sets the columns, unless a value is not allowed: only a distribution can have such.
void set_columns(const Eigen::MatrixXd& shares, const std::vector<PlacedFactor>& factors,
                 v1::Campaign& request, Violations& violations) {
  for (std::size_t k = 0; k < factors.size(); ++k) {
    const PlacedFactor& factor = factors[k];
    const Constraint* row = find_constraint(*factor.field);
    v1::CandidateColumn& column = *request.add_candidate_columns();
    column.set_path(factor.parameter);
    for (Eigen::Index i = 0; i < shares.rows(); ++i) {
      const double value = factor.value(shares(i, static_cast<Eigen::Index>(k)));
      column.add_values(value);
      if (row == nullptr || row->allows(value)) continue;
      violations.add("candidate_design.factors",
                     "by its standard uncertainty of {}, {} of candidate {} would be out of "
                     "range: {}; state a range",
                     number_text(factor.standard_uncertainty), factor.parameter, i,
                     out_of_range_text(*row, value));
      break;
    }
  }
}

void make_design(v1::Campaign& request, const ResourceLookup& lookup, Violations& violations) {
  const std::size_t before = violations.size();
  v1::CandidateDesign& design = *request.mutable_candidate_design();
  check_message(design, "candidate_design", violations);
  if (design.method() == v1::CandidateDesign::METHOD_UNSPECIFIED) {
    violations.add("candidate_design.method", "not set; allowed: GRID, LATIN_HYPERCUBE or SOBOL");
  }
  if (design.seed() < 0 || design.seed() > kLargestSeed) {
    violations.add("candidate_design.seed", "seed = {}; allowed: 0 to {}", design.seed(),
                   kLargestSeed);
  }
  if (design.algorithm_version() < 0 || design.algorithm_version() > kDesignVersion) {
    violations.add("candidate_design.algorithm_version",
                   "algorithm_version = {}; allowed: 0 (the newest one) to {}",
                   design.algorithm_version(), kDesignVersion);
  }
  const SimulationInputs base = base_of_design(request, lookup, violations);
  const bool is_grid = design.method() == v1::CandidateDesign::GRID;
  if (is_grid && design.factors().empty()) {
    violations.add("candidate_design.factors", "not set; allowed in a GRID: at least one");
  }
  const std::vector<PlacedFactor> factors = !design.factors().empty() || is_grid
                                                ? stated_factors(request, base, violations)
                                                : uncertain_factors(request, base, violations);
  const int count = design_size(design, factors, violations);
  if (factors.size() > kMaximumFactors && design.factors().empty()) {
    violations.add("candidate_design.factors",
                   "not set, and {} parameters have a standard uncertainty; "
                   "allowed: at most {}. List those that differ",
                   factors.size(), kMaximumFactors);
  }
  if (violations.size() > before) return;
  design.set_algorithm_version(kDesignVersion);
  set_columns(shares_of(design, count, factors), factors, request, violations);
}

/// Returns the lubricant parameters that count under the law of the base and that every lubricant
/// has.
std::vector<std::pair<std::string, const FieldDescriptor*>> parameters_of(
    const v1::Lubricant& base) {
  std::vector<std::pair<std::string, const FieldDescriptor*>> out;
  for (const std::string& path : candidate_parameter_names()) {
    if (!path.starts_with("lubricant.")) continue;
    const bool is_of_law = path.starts_with("lubricant.improved_yasutomi.");
    const bool is_of_roelands = path.starts_with("lubricant.pressure_viscosity_");
    if (base.has_improved_yasutomi() ? is_of_roelands : is_of_law) continue;
    if (may_be_unset(*find_candidate_parameter(path))) continue;
    out.emplace_back(path, find_candidate_parameter(path));
  }
  return out;
}

double parameter_of(const v1::Lubricant& lubricant, const FieldDescriptor& field) {
  const google::protobuf::Message& holder =
      field.containing_type() == v1::Lubricant::descriptor()
          ? static_cast<const google::protobuf::Message&>(lubricant)
          : lubricant.improved_yasutomi();
  return holder.GetReflection()->GetDouble(holder, &field);
}

/// Adds the standard uncertainties of a parameter, where a lubricant states one.
void add_parameter_uncertainties(
    const std::vector<std::shared_ptr<const v1::Lubricant>>& lubricants, const std::string& path,
    const FieldDescriptor& field, v1::Campaign& out) {
  if (errs_with_a_law(field)) return;
  v1::CandidateAttribute attribute;
  bool is_stated = false;
  for (const auto& each : lubricants) {
    const v1::ParameterProvenance* entry =
        find_provenance(each->provenance(), path.substr(path.find('.') + 1));
    attribute.add_values(entry == nullptr ? 0 : entry->standard_uncertainty());
    is_stated = is_stated || (entry != nullptr && entry->standard_uncertainty() > 0);
  }
  if (!is_stated) return;
  attribute.set_name(field.name() + kUncertaintySuffix);
  *out.add_candidate_attributes() = std::move(attribute);
}

/// Adds a violation for each attribute with a name that the server gives where candidates are
/// lubricants.
void check_not_made(const google::protobuf::RepeatedPtrField<v1::CandidateAttribute>& attributes,
                    Violations& violations) {
  for (int i = 0; i < attributes.size(); ++i) {
    if (!is_made_attribute(attributes[i].name())) continue;
    violations.add(fmt::format("candidate_attributes[{}].name", i),
                   "\"{}\": the server makes this attribute where candidates "
                   "are lubricants; choose another name",
                   plain_excerpt(attributes[i].name()));
  }
}

void make_lubricants(v1::Campaign& request, const ResourceLookup& lookup,
                     const LubricantSearch& search, Violations& violations) {
  if (!request.lubricant_filter().empty()) {
    Violations found;
    const std::vector<std::string> names =
        search ? search(request.lubricant_filter(), found) : std::vector<std::string>();
    for (Violation& each : found) {
      violations.add("lubricant_filter", std::move(each.description));
    }
    if (!found.empty()) return;
    if (names.empty() || names.size() > static_cast<std::size_t>(kMaximumCandidateLubricants)) {
      violations.add("lubricant_filter", "\"{}\" is satisfied by {} lubricant{}; allowed: 1 to {}",
                     plain_excerpt(request.lubricant_filter()),
                     names.empty() ? "no" : "more than " + std::to_string(names.size() - 1),
                     names.empty() ? "" : "s", kMaximumCandidateLubricants);
      return;
    }
    *request.mutable_candidate_lubricants() = {names.begin(), names.end()};
  }
  if (request.lubricant().empty()) request.set_lubricant(request.candidate_lubricants(0));
  check_not_made(request.candidate_attributes(), violations);
  const auto base = find_resource<v1::Lubricant>(lookup, request.lubricant(), kLubricants,
                                                 "lubricant", violations);
  if (!base) return;
  v1::Campaign made =
      lubricant_candidates(request.candidate_lubricants(), *base->resource, lookup, violations);
  request.mutable_candidate_lubricants()->Swap(made.mutable_candidate_lubricants());
  request.mutable_candidate_columns()->Swap(made.mutable_candidate_columns());
  for (v1::CandidateAttribute& each : *made.mutable_candidate_attributes()) {
    *request.add_candidate_attributes() = std::move(each);
  }
}

}  // namespace

bool has_made_columns(const v1::Campaign& requested) {
  return requested.has_candidate_design() || !requested.lubricant_filter().empty() ||
         !requested.candidate_lubricants().empty();
}

bool has_lubricants(const v1::Campaign& requested, const v1::Campaign& table) {
  return !requested.lubricant_filter().empty() || !requested.candidate_lubricants().empty() ||
         !table.candidate_lubricants().empty();
}

bool is_made_attribute(const std::string& name) {
  return name == "name" || name.ends_with(kUncertaintySuffix);
}

void replace_attributes(
    const google::protobuf::RepeatedPtrField<v1::CandidateAttribute>& attributes,
    v1::Campaign& table, Violations& violations) {
  google::protobuf::RepeatedPtrField<v1::CandidateAttribute> made;
  if (!table.candidate_lubricants().empty()) {
    check_not_made(attributes, violations);
    for (const v1::CandidateAttribute& each : table.candidate_attributes()) {
      if (is_made_attribute(each.name())) *made.Add() = each;
    }
  }
  *table.mutable_candidate_attributes() = attributes;
  table.mutable_candidate_attributes()->MergeFrom(made);
}

void keep_first_candidates(int count, v1::Campaign& table) {
  const auto shorten = [count](auto& values) {
    if (values.size() > count) values.Truncate(count);
  };
  const auto shorten_texts = [count](auto& texts) {
    if (texts.size() > count) texts.DeleteSubrange(count, texts.size() - count);
  };
  for (v1::CandidateColumn& each : *table.mutable_candidate_columns()) {
    shorten(*each.mutable_values());
  }
  for (v1::CandidateAttribute& each : *table.mutable_candidate_attributes()) {
    shorten(*each.mutable_values());
    shorten_texts(*each.mutable_texts());
  }
  shorten_texts(*table.mutable_candidate_lubricants());
}

void make_candidates(v1::Campaign& request, const ResourceLookup& lookup,
                     const LubricantSearch& search, Violations& violations) {
  std::vector<std::string> stated;
  if (!request.candidate_columns().empty()) stated.emplace_back("candidate_columns");
  if (request.has_candidate_design()) stated.emplace_back("candidate_design");
  if (!request.candidate_lubricants().empty()) stated.emplace_back("candidate_lubricants");
  if (!request.lubricant_filter().empty()) stated.emplace_back("lubricant_filter");
  if (stated.size() > 1) {
    violations.add(stated[1],
                   "set beside {}; allowed: one of the two. Each states what the candidates are",
                   stated[0]);
    return;
  }
  if (request.candidate_lubricants_size() > kMaximumCandidateLubricants) return;  // check_message()
  if (request.has_candidate_design()) {
    make_design(request, lookup, violations);
  } else if (has_made_columns(request)) {
    make_lubricants(request, lookup, search, violations);
  }
}

v1::Campaign lubricant_candidates(const google::protobuf::RepeatedPtrField<std::string>& lubricants,
                                  const v1::Lubricant& base, const ResourceLookup& lookup,
                                  Violations& violations) {
  v1::Campaign out;
  std::vector<std::shared_ptr<const v1::Lubricant>> found;
  const std::size_t before = violations.size();
  std::map<std::string, int> positions;
  for (int i = 0; i < lubricants.size(); ++i) {
    if (violations.size() >= before + kMaximumReportedElements) return out;
    const std::string path = fmt::format("candidate_lubricants[{}]", i);
    auto each = find_resource<v1::Lubricant>(lookup, lubricants[i], kLubricants, path, violations);
    if (!each) continue;
    const auto [at, is_new] = positions.emplace(each->revision_name, i);
    if (!is_new) {
      violations.add(path, "{} is listed twice, first as candidate_lubricants[{}]; allowed: once",
                     each->revision_name, at->second);
    } else if (each->resource->has_improved_yasutomi() != base.has_improved_yasutomi()) {
      violations.add(path,
                     "{} {} improved_yasutomi, unlike the base; allowed: lubricants with one law "
                     "of viscosity under pressure. Screen the others in a campaign of their own",
                     each->revision_name,
                     each->resource->has_improved_yasutomi() ? "follows" : "does not follow");
    }
    *out.add_candidate_lubricants() = each->revision_name;
    found.push_back(std::move(each->resource));
  }
  if (violations.size() > before) return out;
  v1::CandidateAttribute& name = *out.add_candidate_attributes();
  name.set_name("name");
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string& revision = out.candidate_lubricants(static_cast<int>(i));
    const std::size_t begin = revision.find('/') + 1;
    name.add_texts(found[i]->display_name().empty()
                       ? revision.substr(begin, revision.find('@') - begin)
                       : found[i]->display_name());
  }
  for (const auto& [path, field] : parameters_of(base)) {
    v1::CandidateColumn& column = *out.add_candidate_columns();
    column.set_path(path);
    for (const auto& each : found) column.add_values(parameter_of(*each, *field));
    add_parameter_uncertainties(found, path, *field, out);
  }
  return out;
}

}  // namespace tribodyn::server

#include "server/simulation/candidate_uncertainty.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <utility>

#include "core/uncertainty/drawn_value.h"
#include "core/uncertainty/normal_draws.h"
#include "server/contract/constraints.h"
#include "server/resources/provenance.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/campaign_scene.h"
#include "server/simulation/input_deviations.h"
#include "server/simulation/input_errors.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;

/// Returns the message of the base that holds a parameter; null if it has none, or follows another
/// pressure-viscosity law.
const google::protobuf::Message* holder_of(const FieldDescriptor& field,
                                           const SimulationInputs& base) {
  const v1::Lubricant& lubricant = *base.lubricant;
  if (field.containing_type() == v1::Surface::descriptor()) return base.surface.get();
  if (field.containing_type() == v1::Lubricant::descriptor()) {
    const bool is_of_roelands = field.name().starts_with("pressure_viscosity_");
    return is_of_roelands && lubricant.has_improved_yasutomi() ? nullptr : &lubricant;
  }
  return lubricant.has_improved_yasutomi() ? &lubricant.improved_yasutomi() : nullptr;
}

const v1::ParameterUncertainty* find_stated(const v1::RankCandidatesRequest& request,
                                            const std::string& path) {
  for (const v1::ParameterUncertainty& each : request.uncertainties()) {
    if (each.parameter() == path) return &each;
  }
  return nullptr;
}

const PointEvaluation::Column* find_varied(const PointEvaluation& points,
                                           const FieldDescriptor* field) {
  const auto found = std::find_if(points.columns.begin(), points.columns.end(),
                                  [field](const auto& each) { return each.field == field; });
  return found == points.columns.end() ? nullptr : &*found;
}

const v1::CandidateAttribute* find_attribute(const v1::Campaign& table, const std::string& name) {
  for (const v1::CandidateAttribute& each : table.candidate_attributes()) {
    if (each.name() == name && !each.values().empty()) return &each;
  }
  return nullptr;
}

double within_limits(const FieldDescriptor& field, double value) {
  const Constraint* row = find_constraint(field);
  return row == nullptr ? value : std::clamp(value, row->minimum, row->maximum);
}

/// Leaves out what is not needed for a column: the numbers of the columns before it stay. A rig has
/// all of its columns.
void keep_column(int column, PointEvaluation& points) {
  const auto first_contact = static_cast<int>(kCampaignColumns.size());
  const auto first_elasticity =
      first_contact + static_cast<int>(points.with_contact ? kContactFigureColumns.size() : 0);
  if (column < first_elasticity) points.elasticities.clear();
  if (column < first_contact) points.with_contact = false;
}

}  // namespace

bool errs_with_a_law(const FieldDescriptor& field) {
  return field.name().starts_with("vogel_") || field.name().starts_with("density_");
}

std::optional<double> base_value(const FieldDescriptor& field, const SimulationInputs& base) {
  const google::protobuf::Message* holder = holder_of(field, base);
  if (holder == nullptr) return std::nullopt;
  const auto& reflection = *holder->GetReflection();
  if (field.has_presence() && !reflection.HasField(*holder, &field)) return std::nullopt;
  return reflection.GetDouble(*holder, &field);
}

double stated_by_base(const std::string& path, const FieldDescriptor& field,
                      const SimulationInputs& base) {
  if (errs_with_a_law(field)) return 0;
  const bool is_of_surface = field.containing_type() == v1::Surface::descriptor();
  if (is_of_surface && !base.surface) return 0;
  const auto& entries = is_of_surface ? base.surface->provenance() : base.lubricant->provenance();
  const v1::ParameterProvenance* entry = find_provenance(entries, path.substr(path.find('.') + 1));
  return entry == nullptr ? 0 : entry->standard_uncertainty();
}

void check_uncertainties(const v1::RankCandidatesRequest& request, Violations& violations) {
  std::set<std::string> paths;
  for (int i = 0; i < request.uncertainties_size(); ++i) {
    const v1::ParameterUncertainty& each = request.uncertainties(i);
    const std::string path = fmt::format("uncertainties[{}]", i);
    if (find_candidate_parameter(each.parameter()) == nullptr) {
      violations.add(path + ".parameter", unknown_parameter_text(each.parameter()));
    } else if (!paths.insert(each.parameter()).second) {
      violations.add(path + ".parameter", "\"{}\" is listed twice; allowed: once",
                     each.parameter());
    }
    const bool is_relative = each.has_relative_uncertainty();
    const double value = is_relative ? each.relative_uncertainty() : each.absolute_uncertainty();
    if (!(value > 0)) {
      violations.add(path + (is_relative ? ".relative_uncertainty" : ".absolute_uncertainty"),
                     each.form_case() == v1::ParameterUncertainty::FORM_NOT_SET
                         ? std::string("not set; allowed: this or relative_uncertainty, above 0")
                         : fmt::format("{}; allowed: above 0", number_text(value)));
    }
  }
}

namespace {

constexpr std::uint64_t kSeed = 1;  // as of ComparePoints
constexpr int kUsualDraws = 199;
constexpr double kUsualCorrelation = 0.5;

int draws_of(const v1::RankCandidatesRequest& request) {
  return request.draws() == 0 ? kUsualDraws : request.draws();
}

/// Returns the error of one parameter.
InputError parameter_error(const std::string& path, const FieldDescriptor& field, double value,
                           double uncertainty, InputError::Sharing sharing) {
  return {
      path,
      sharing,
      "",
      1,
      [&field, value, uncertainty](std::span<const double> deviations, UncertainInputs& inputs) {
        google::protobuf::Message* holder = &inputs.lubricant;
        if (field.containing_type() == v1::Surface::descriptor()) holder = &inputs.surface;
        if (field.containing_type() == v1::ImprovedYasutomi::descriptor()) {
          holder = inputs.lubricant.mutable_improved_yasutomi();
        }
        holder->GetReflection()->SetDouble(
            holder, &field, within_limits(field, drawn_value(value, uncertainty, deviations[0])));
      },
      uncertainty};
}

double stated_uncertainty(const v1::ParameterUncertainty& stated, double value) {
  return stated.has_relative_uncertainty() ? stated.relative_uncertainty() * std::abs(value)
                                           : stated.absolute_uncertainty();
}

/// Returns the errors of a candidate whose parameters are columns: those that the request states,
/// those that an attribute states, and of parameters without a column those of the base.
std::vector<InputError> errors_of_columns(const v1::RankCandidatesRequest& request,
                                          const CampaignInputs& inputs, std::size_t candidate) {
  const SimulationInputs& base = inputs.points.base;
  std::vector<InputError> out;
  for (const std::string& path : candidate_parameter_names()) {
    const FieldDescriptor* field = find_candidate_parameter(path);
    const PointEvaluation::Column* varied = find_varied(inputs.points, field);
    const auto* attribute = find_attribute(inputs.table, field->name() + ".uncertainty");
    const v1::ParameterUncertainty* stated = find_stated(request, path);
    const std::optional<double> usual = base_value(*field, base);
    if (!usual && varied == nullptr) continue;
    const double value = varied == nullptr ? *usual : varied->values[candidate];
    double uncertainty = attribute == nullptr ? 0 : attribute->values(static_cast<int>(candidate));
    if (!(uncertainty > 0) && stated != nullptr) {
      uncertainty = stated_uncertainty(*stated, value);
    } else if (!(uncertainty > 0) && varied == nullptr && !request.ignore_stated_uncertainties()) {
      uncertainty = stated_by_base(path, *field, base);
    }
    if (!(uncertainty > 0)) continue;
    const bool is_shared = varied == nullptr && attribute == nullptr;
    out.push_back(
        parameter_error(path, *field, value, uncertainty,
                        is_shared ? InputError::Sharing::kScene : InputError::Sharing::kOwn));
  }
  return out;
}

/// Returns the errors of a candidate that is a lubricant: those of ComparePoints, but for what the
/// request states.
std::vector<InputError> errors_of_lubricant(const v1::RankCandidatesRequest& request,
                                            const CampaignInputs& inputs, std::size_t candidate) {
  const v1::Lubricant& lubricant = *inputs.points.lubricants[candidate];
  SimulationInputs own = inputs.points.base;
  own.lubricant = inputs.points.lubricants[candidate];
  std::vector<InputError> out;
  if (!request.ignore_stated_uncertainties()) {
    out = lubricant_errors(lubricant).errors;
    if (own.surface) {
      for (InputError& each : surface_errors(*own.surface).errors) out.push_back(std::move(each));
    }
  }
  for (const v1::ParameterUncertainty& stated : request.uncertainties()) {
    const FieldDescriptor* field = find_candidate_parameter(stated.parameter());
    const std::optional<double> value = base_value(*field, own);
    if (!value) continue;
    std::erase_if(out, [&stated](const InputError& each) {
      return (" " + each.input + " ").find(" " + stated.parameter() + " ") != std::string::npos;
    });
    const bool is_surface = field->containing_type() == v1::Surface::descriptor();
    out.push_back(
        parameter_error(stated.parameter(), *field, *value, stated_uncertainty(stated, *value),
                        is_surface ? InputError::Sharing::kScene : InputError::Sharing::kOwn));
  }
  return out;
}

void add_words(const std::string& words, std::set<std::string>& out) {
  std::istringstream stream(words);
  for (std::string word; stream >> word;) out.insert(word);
}

}  // namespace

std::size_t CandidateDraws::points_of_each() const {
  return (static_cast<std::size_t>(draws_of(request)) + 1) * aggregate.conditions();
}

DrawnCandidates CandidateDraws::compute(CampaignInputs inputs, PreparedGearSets& gear_sets,
                                        const std::function<bool()>& is_over) const {
  PointEvaluation& points = inputs.points;
  keep_column(column, points);
  DrawnCandidates out;
  out.values.resize(candidates.size());
  std::vector<std::vector<InputError>> errors;
  std::vector<std::vector<std::vector<Mixture>>> mixtures;
  Deviations deviations(request.has_estimate_correlation() ? request.estimate_correlation()
                                                           : kUsualCorrelation);
  for (const std::size_t candidate : candidates) {
    const bool is_lubricant = !points.lubricants.empty();
    errors.push_back(is_lubricant ? errors_of_lubricant(request, inputs, candidate)
                                  : errors_of_columns(request, inputs, candidate));
    const std::string owner = is_lubricant
                                  ? inputs.table.candidate_lubricants(static_cast<int>(candidate))
                                  : std::to_string(candidate);
    auto& own = mixtures.emplace_back();
    for (const InputError& each : errors.back()) {
      own.push_back(deviations.of(each, owner));
      add_words(each.input,
                each.sharing == InputError::Sharing::kScene ? out.shared_inputs : out.own_inputs);
    }
  }
  const auto& attributes = inputs.table.candidate_attributes();
  const bool is_asked =
      !request.uncertainties().empty() ||
      std::any_of(attributes.begin(), attributes.end(), [&points](const auto& each) {
        return points.lubricants.empty() && each.name().ends_with(".uncertainty");
      });
  if (out.own_inputs.empty() && !(is_asked && !out.shared_inputs.empty())) return out;
  out.draws = draws_of(request);
  const NormalDraws normal(out.draws, deviations.count(), kSeed);

  const auto scene = campaign_scene(inputs, [&is_over] { return !is_over(); });
  const auto gear_set = scene->take_gear_set(gear_sets);
  std::vector<CampaignRow> rows(static_cast<std::size_t>(points.conditions));
  std::vector<double> figures(rows.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool has_own = std::any_of(
        errors[i].begin(), errors[i].end(),
        [](const InputError& each) { return each.sharing != InputError::Sharing::kScene; });
    const bool is_skipped = i > 0 && i < first;
    if (is_skipped || (!has_own && !is_asked)) continue;
    CandidateResources stated{*points.base.lubricant,
                              points.base.surface ? *points.base.surface : v1::Surface()};
    stated.set(points, static_cast<int>(candidates[i]));
    UncertainInputs drawn;
    drawn.lubricant = std::move(stated.lubricant);
    drawn.surface = std::move(stated.surface);
    for (int n = 0; n < out.draws; ++n) {
      if (n > 0 && errors[i].empty()) {  // exact, among others that are not
        out.values[i].push_back(out.values[i].front());
        continue;
      }
      for (std::size_t k = 0; k < errors[i].size(); ++k) {
        std::vector<double> deviation;
        for (const Mixture& each : mixtures[i][k]) deviation.push_back(each.at(normal, n));
        errors[i][k].apply(deviation, drawn);
      }
      scene->set_inputs(drawn);
      for (std::size_t group = 0; group < scene->groups(); ++group) {
        scene->evaluate(group, gear_set, rows);
      }
      for (std::size_t k = 0; k < rows.size(); ++k) figures[k] = rows[k].value(column);
      out.values[i].push_back(aggregate.value(figures));
    }
  }
  // As in evaluate_points(), an exception drops the gear set.
  scene->give_back(gear_sets, gear_set);
  return out;
}

}  // namespace tribodyn::server

#include "server/simulation/candidate_uncertainty.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "core/uncertainty/drawn_value.h"
#include "server/contract/constraints.h"
#include "server/resources/provenance.h"
#include "server/simulation/campaign_columns.h"
#include "server/simulation/campaign_scene.h"

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

std::vector<UncertainParameter> uncertain_parameters(const v1::RankCandidatesRequest& request,
                                                     const CampaignInputs& inputs) {
  const SimulationInputs& base = inputs.points.base;
  std::vector<UncertainParameter> out;
  for (const std::string& path : candidate_parameter_names()) {
    const FieldDescriptor* field = find_candidate_parameter(path);
    const PointEvaluation::Column* varied = find_varied(inputs.points, field);
    const auto* attribute = find_attribute(inputs.table, field->name() + ".uncertainty");
    const v1::ParameterUncertainty* stated = find_stated(request, path);
    const std::optional<double> usual = base_value(*field, base);
    if (!usual && varied == nullptr) continue;
    UncertainParameter parameter{path, field, varied == nullptr && attribute == nullptr, {}};
    bool is_uncertain = false;
    for (int i = 0; i < inputs.points.candidates; ++i) {
      const double value = varied == nullptr ? *usual : varied->values[static_cast<std::size_t>(i)];
      double uncertainty = attribute == nullptr ? 0 : std::max(0.0, attribute->values(i));
      if (uncertainty == 0 && stated != nullptr) {
        uncertainty = stated->has_relative_uncertainty()
                          ? stated->relative_uncertainty() * std::abs(value)
                          : stated->absolute_uncertainty();
      } else if (uncertainty == 0 && varied == nullptr && !request.ignore_stated_uncertainties()) {
        uncertainty = stated_by_base(path, *field, base);
      }
      parameter.uncertainties.push_back(uncertainty);
      is_uncertain = is_uncertain || uncertainty > 0;
    }
    if (is_uncertain) out.push_back(std::move(parameter));
  }
  return out;
}

std::vector<std::vector<double>> EffectsStudy::compute(CampaignInputs inputs,
                                                       PreparedGearSets& gear_sets,
                                                       const std::function<bool()>& is_over) const {
  PointEvaluation& points = inputs.points;
  keep_column(column, points);
  for (const UncertainParameter& each : parameters) {
    if (find_varied(points, each.field) != nullptr) continue;
    const double usual = *base_value(*each.field, points.base);
    points.columns.push_back(
        {each.field, std::vector<double>(static_cast<std::size_t>(points.candidates), usual)});
  }
  // Of each candidate a row with each parameter lower and one with it higher.
  std::vector<PointEvaluation::Column> moved;
  for (const PointEvaluation::Column& each : points.columns) {
    std::vector<double>& values =
        moved.emplace_back(PointEvaluation::Column{each.field, {}}).values;
    for (const std::size_t candidate : candidates) {
      const double value = each.values[candidate];
      for (const UncertainParameter& parameter : parameters) {
        for (const double deviation : {-1.0, 1.0}) {
          const double uncertainty = parameter.uncertainties[candidate];
          values.push_back(
              parameter.field != each.field
                  ? value
                  : within_limits(*each.field, drawn_value(value, uncertainty, deviation)));
        }
      }
    }
  }
  points.columns = std::move(moved);
  points.candidates = static_cast<int>(2 * candidates.size() * parameters.size());

  const auto scene = campaign_scene(inputs, [&is_over] { return !is_over(); });
  const auto gear_set = scene->take_gear_set(gear_sets);
  std::vector<CampaignRow> rows(static_cast<std::size_t>(points.conditions));
  std::vector<double> values(rows.size());
  std::vector<double> figures;
  for (int i = 0; i < points.candidates; ++i) {
    scene->set_candidate(i);
    for (std::size_t group = 0; group < scene->groups(); ++group) {
      scene->evaluate(group, gear_set, rows);
    }
    for (std::size_t k = 0; k < rows.size(); ++k) values[k] = rows[k].value(column);
    figures.push_back(aggregate.value(values));
  }
  // As in evaluate_points(), an exception drops the gear set.
  scene->give_back(gear_sets, gear_set);

  std::vector<std::vector<double>> out;
  auto figure = figures.begin();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    std::vector<double>& effects = out.emplace_back();
    for (std::size_t k = 0; k < parameters.size(); ++k, figure += 2) {
      effects.push_back(0.5 * (*(figure + 1) - *figure));
    }
  }
  return out;
}

}  // namespace tribodyn::server

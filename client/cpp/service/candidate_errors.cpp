#include "client/cpp/service/candidate_errors.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "client/cpp/resources/kind.h"
#include "client/cpp/service/point_batches.h"
#include "core/uncertainty/drawn_value.h"

namespace tribodyn::client {
namespace {

using google::protobuf::FieldDescriptor;

const CandidateParameter* find_field(const std::vector<CandidateParameter>& parameters,
                                     const FieldDescriptor* field) {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [field](const auto& each) { return each.field == field; });
  return found == parameters.end() ? nullptr : &*found;
}

/// Returns the allowed value nearest to `value`.
double within_limits(const v1::Schema& schema, const FieldDescriptor& field, double value) {
  for (const v1::Constraint& row : schema.constraints()) {
    if (row.field() != field.name() || row.message() != field.containing_type()->name()) continue;
    return std::clamp(value, row.minimum(), row.maximum());
  }
  return value;
}

}  // namespace

std::vector<UncertainInput> uncertain_inputs(const Screening& screening,
                                             const std::vector<StatedUncertainty>& stated) {
  std::vector<UncertainInput> out;
  for (const FieldDescriptor* field : candidate_parameters()) {
    const CandidateParameter* varied = find_field(screening.table.parameters, field);
    const CandidateParameter* column = find_field(screening.table.uncertainties, field);
    const auto given = std::find_if(stated.begin(), stated.end(),
                                    [field](const auto& each) { return each.field == field; });
    UncertainInput input{field, varied == nullptr && column == nullptr, {}};
    const double usual = base_value(screening.bases, *field);
    for (std::size_t i = 0; i < screening.table.size(); ++i) {
      const double value = varied == nullptr ? usual : varied->values[i];
      double uncertainty = column == nullptr ? 0 : column->values[i];
      if (uncertainty == 0 && given != stated.end()) {
        uncertainty = given->is_relative ? given->value * std::abs(value) : given->value;
      } else if (uncertainty == 0 && varied == nullptr) {
        uncertainty = stated_uncertainty(screening.bases, *field);
      }
      input.uncertainties.push_back(std::isfinite(value) ? uncertainty : 0);
    }
    if (std::any_of(input.uncertainties.begin(), input.uncertainties.end(),
                    [](double each) { return each > 0; })) {
      out.push_back(std::move(input));
    }
  }
  return out;
}

std::vector<std::vector<double>> input_effects(Connection& connection, const Screening& screening,
                                               const v1::Schema& schema,
                                               const std::vector<UncertainInput>& inputs,
                                               const std::vector<std::size_t>& candidates) {
  // Of each candidate a row with each input lower and one with it higher.
  std::vector<CandidateParameter> parameters = screening.table.parameters;
  for (const UncertainInput& input : inputs) {
    if (find_field(parameters, input.field) != nullptr) continue;
    CandidateParameter& added = parameters.emplace_back();
    added.field = input.field;
    added.values.assign(screening.table.size(), base_value(screening.bases, *input.field));
  }
  std::vector<CandidateParameter> moved = parameters;
  for (CandidateParameter& each : moved) each.values.clear();
  for (const std::size_t i : candidates) {
    for (const UncertainInput& input : inputs) {
      for (const double deviation : {-1.0, 1.0}) {
        for (std::size_t k = 0; k < parameters.size(); ++k) {
          double value = parameters[k].values[i];
          if (parameters[k].field == input.field) {
            value = within_limits(schema, *input.field,
                                  drawn_value(value, input.uncertainties[i], deviation));
          }
          moved[k].values.push_back(value);
        }
      }
    }
  }
  std::vector<double> means;
  std::vector<std::size_t> rows(candidates.size() * inputs.size() * 2);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  evaluate_candidates(
      connection, screening.request, moved, rows,
      [&](const PointBatch& batch) {
        for (std::size_t i = 0; i < batch.count; ++i) {
          double mean = 0;
          for (std::size_t k = 0; k < screening.conditions(); ++k) {
            const auto row = static_cast<int>(i * screening.conditions() + k);
            mean += screening.weights[k] * batch.answer.inefficiency_energy_mean_percent(row);
          }
          means.push_back(mean);
        }
      },
      [] { return true; });
  std::vector<std::vector<double>> out;
  auto mean = means.begin();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    std::vector<double>& effects = out.emplace_back();
    for (std::size_t k = 0; k < inputs.size(); ++k, mean += 2) {
      effects.push_back(0.5 * (*(mean + 1) - *mean));
    }
  }
  return out;
}

}  // namespace tribodyn::client

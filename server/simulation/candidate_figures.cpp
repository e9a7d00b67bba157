#include "server/simulation/candidate_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "server/simulation/campaign_rig.h"

namespace tribodyn::server {
namespace {

bool keeps(const v1::CandidateConstraint& constraint, double value) {
  return (!constraint.has_minimum() || value >= constraint.minimum()) &&
         (!constraint.has_maximum() || value <= constraint.maximum());
}

}  // namespace

std::vector<double> condition_weights(const google::protobuf::RepeatedField<double>& stated,
                                      const v1::Campaign& campaign, Violations& violations) {
  const int conditions = condition_count(campaign);
  if (!stated.empty() && stated.size() != conditions) {
    violations.add("condition_weights",
                   "{} weights; allowed: one for each of the {} conditions, or "
                   "none for those of the campaign",
                   stated.size(), conditions);
    return {};
  }
  const auto& usual = stated.empty() ? campaign.condition_weights() : stated;
  std::vector<double> out(usual.begin(), usual.end());
  out.resize(static_cast<std::size_t>(conditions), 1);  // of a campaign without weights
  const double sum = std::accumulate(out.begin(), out.end(), 0.0);
  for (double& each : out) each /= sum;
  return out;
}

ConditionAggregate::ConditionAggregate(v1::CandidateFigure::Aggregate kind,
                                       std::vector<double> weights)
    : kind_(kind), weights_(std::move(weights)) {}

double ConditionAggregate::value(std::span<const double> values) const {
  const bool is_whole =
      std::none_of(values.begin(), values.end(), [](double each) { return std::isnan(each); });
  if (!is_whole) return std::numeric_limits<double>::quiet_NaN();
  switch (kind_) {
    case v1::CandidateFigure::MINIMUM:
      return *std::min_element(values.begin(), values.end());
    case v1::CandidateFigure::MAXIMUM:
      return *std::max_element(values.begin(), values.end());
    default:
      return std::inner_product(values.begin(), values.end(), weights_.begin(), 0.0);
  }
}

double ConditionAggregate::error(std::span<const double> errors) const {
  switch (kind_) {
    case v1::CandidateFigure::MINIMUM:
    case v1::CandidateFigure::MAXIMUM:
      return *std::max_element(errors.begin(), errors.end());
    default:
      return std::inner_product(errors.begin(), errors.end(), weights_.begin(), 0.0);
  }
}

CandidateSelection select_candidates(
    const std::vector<bool>& missing, const std::vector<CandidateValues>& figures,
    const google::protobuf::RepeatedPtrField<v1::CandidateConstraint>& constraints) {
  CandidateSelection out;
  const std::size_t first = figures.size() - static_cast<std::size_t>(constraints.size());
  for (std::size_t i = 0; i < missing.size(); ++i) {
    const bool has_figures =
        std::none_of(figures.begin(), figures.end(),
                     [i](const CandidateValues& each) { return std::isnan(each.values[i]); });
    if (missing[i]) {
      ++out.missing;
    } else if (!has_figures) {
      ++out.refused;
    } else {
      bool is_kept = true;
      for (int k = 0; k < constraints.size(); ++k) {
        const double value = figures[first + static_cast<std::size_t>(k)].values[i];
        is_kept = is_kept && keeps(constraints[k], value);
      }
      if (is_kept) {
        out.candidates.push_back(i);
      } else {
        ++out.excluded;
      }
    }
  }
  return out;
}

}  // namespace tribodyn::server

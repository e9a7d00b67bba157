#include "server/simulation/campaign_columns.h"

#include <limits>
#include <span>

#include "server/mapping/from_core.h"

namespace tribodyn::server {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::array<double, kCampaignColumns.size()> figures_of(const EvaluatedPoint& point, int refusal) {
  std::array<double, kCampaignColumns.size()> out;
  out.fill(kNone);
  out[0] = refusal;
  if (!point.figures) return out;
  const PointFigures& figures = *point.figures;
  return {static_cast<double>(refusal),
          figures.pinion_torque,
          figures.wheel_torque,
          figures.inefficiency_rms.value_or(kNone),
          figures.inefficiency_energy_mean.value_or(kNone),
          figures.mesh_loss_power,
          figures.dte_minimum,
          figures.dte_maximum,
          figures.contact_loss ? 1.0 : 0.0,
          figures.settled ? 1.0 : 0.0,
          static_cast<double>(figures.period_in_mesh_cycles),
          figures.estimated_relative_error.value_or(kNone),
          static_cast<double>(to_message(figures.model))};
}

std::array<double, kContactFigureColumns.size()> contact_figures_of(const EvaluatedPoint& point) {
  std::array<double, kContactFigureColumns.size()> out;
  out.fill(kNone);
  if (!point.figures || !point.figures->contact) return out;
  const ContactSummary& contact = *point.figures->contact;
  return {contact.film_ratio_minimum,
          contact.film_ratio_mean,
          contact.contact_temperature_maximum,
          contact.contact_temperature_mean,
          contact.viscous_loss_power,
          contact.boundary_loss_power,
          contact.friction_coefficient_mean,
          contact.pressure_maximum,
          contact.flash_temperature_rise_maximum};
}

}  // namespace

std::vector<std::string> campaign_columns(const v1::Campaign& campaign) {
  std::vector<std::string> out(kCampaignColumns.begin(), kCampaignColumns.end());
  if (campaign.contact_figures()) {
    out.insert(out.end(), kContactFigureColumns.begin(), kContactFigureColumns.end());
  }
  if (campaign.elasticity_parameters().empty()) return out;
  out.emplace_back("elasticities_one_sided");
  std::vector<std::string> figures(campaign.elasticity_figures().begin(),
                                   campaign.elasticity_figures().end());
  if (figures.empty()) figures.emplace_back(kDefaultElasticityFigure);
  for (const std::string& figure : figures) {
    for (const std::string& parameter : campaign.elasticity_parameters()) {
      out.push_back("elasticity." + figure + "." + parameter);
    }
  }
  return out;
}

void add_campaign_row(const PointEvaluation& evaluation, const EvaluatedPoint& point, int refusal,
                      std::vector<std::vector<double>>& columns) {
  std::size_t next = 0;
  const auto add = [&](std::span<const double> values) {
    for (const double value : values) columns[next++].push_back(value);
  };
  add(figures_of(point, refusal));
  if (evaluation.with_contact) add(contact_figures_of(point));
  if (evaluation.elasticities.empty()) return;
  columns[next++].push_back(point.figures ? (point.is_one_sided ? 1.0 : 0.0) : kNone);
  if (point.figures) return add(point.elasticities);
  for (; next < columns.size(); ++next) columns[next].push_back(kNone);
}

double campaign_value(const PointEvaluation& evaluation, const EvaluatedPoint& point, int column) {
  std::vector<std::vector<double>> row(
      kCampaignColumns.size() + (evaluation.with_contact ? kContactFigureColumns.size() : 0) +
      (evaluation.elasticities.empty() ? 0 : 1 + evaluation.elasticities.size()));
  add_campaign_row(evaluation, point, 0, row);
  return row[static_cast<std::size_t>(column)].front();
}

}  // namespace tribodyn::server

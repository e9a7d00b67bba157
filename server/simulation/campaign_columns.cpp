#include "server/simulation/campaign_columns.h"

#include <cstdint>
#include <limits>
#include <utility>

#include "core/study/warning_kinds.h"
#include "server/mapping/from_core.h"

namespace tribodyn::server {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr char kUsualAxleFigure[] = "inefficiency_energy_mean_percent";

/// Warnings beyond this number have no bit: they are of inputs, and of no row.
constexpr int kBits = 32;

void append_warnings(const std::vector<RangeWarning>& warnings, std::vector<double>& out) {
  std::uint32_t bits = 0;
  for (const RangeWarning& each : warnings) {
    const int number = warning_number(each.code);
    if (number >= 0 && number < kBits) bits |= std::uint32_t{1} << number;
  }
  out.push_back(bits);
  out.push_back(any_withholds_verdict(warnings) ? 1 : 0);
}

void append_axle_figures(const PointFigures& figures, std::vector<double>& out) {
  out.insert(
      out.end(),
      {figures.pinion_torque, figures.wheel_torque, figures.inefficiency_rms.value_or(kNone),
       figures.inefficiency_energy_mean.value_or(kNone), figures.mesh_loss_power,
       figures.dte_minimum, figures.dte_maximum, figures.contact_loss ? 1.0 : 0.0,
       figures.settled ? 1.0 : 0.0, static_cast<double>(figures.period_in_mesh_cycles),
       figures.estimated_relative_error.value_or(kNone),
       static_cast<double>(to_message(figures.model)), responses_coexist(figures) ? 1.0 : 0.0});
  append_warnings(figures.warnings, out);
}

void append_axle_contact(const PointFigures& figures, std::vector<double>& out) {
  if (!figures.contact) {
    out.insert(out.end(), kContactFigureColumns.size(), kNone);
    return;
  }
  const ContactSummary& contact = *figures.contact;
  out.insert(out.end(), {contact.film_ratio_minimum, contact.film_ratio_mean,
                         contact.contact_temperature_maximum, contact.contact_temperature_mean,
                         contact.viscous_loss_power, contact.boundary_loss_power,
                         contact.friction_coefficient_mean, contact.pressure_maximum,
                         contact.flash_temperature_rise_maximum});
}

}  // namespace

std::vector<std::string> campaign_columns(const v1::Campaign& campaign) {
  if (campaign.has_rig()) {
    std::vector<std::string> of_rig{std::string(kCampaignColumns.front()),
                                    std::string(kWarningBits), std::string(kVerdictWithheld)};
    for (const RigColumn& each : rig_columns()) of_rig.emplace_back(each.name);
    return of_rig;
  }
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

std::string usual_figure(const v1::Campaign& campaign) {
  return campaign.has_rig() ? std::string(rig_columns().front().name) : kUsualAxleFigure;
}

void CampaignRow::set(const PointEvaluation& evaluation, const EvaluatedPoint& point) {
  figures.clear();
  refusal_reason = point.refusal_reason;
  refusal_message = point.refusal_message;
  if (!point.figures) return;
  append_axle_figures(*point.figures, figures);
  if (evaluation.with_contact) append_axle_contact(*point.figures, figures);
  if (evaluation.elasticities.empty()) return;
  figures.push_back(point.is_one_sided ? 1 : 0);
  figures.insert(figures.end(), point.elasticities.begin(), point.elasticities.end());
}

void CampaignRow::set(const RigPoint& point, const std::vector<RangeWarning>& warnings) {
  figures.clear();
  refusal_reason.clear();
  refusal_message.clear();
  append_warnings(warnings, figures);
  for (const RigColumn& each : rig_columns()) figures.push_back(point.*each.figure);
}

void CampaignRow::refuse(std::string reason, std::string message) {
  figures.clear();
  refusal_reason = std::move(reason);
  refusal_message = std::move(message);
}

double CampaignRow::value(int column) const {
  return figures.empty() ? kNone : figures[static_cast<std::size_t>(column - 1)];
}

void add_campaign_row(const CampaignRow& row, int refusal,
                      std::vector<std::vector<double>>& columns) {
  columns.front().push_back(refusal);
  for (std::size_t i = 1; i < columns.size(); ++i) {
    columns[i].push_back(row.value(static_cast<int>(i)));
  }
}

}  // namespace tribodyn::server

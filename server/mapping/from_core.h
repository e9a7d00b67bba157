#pragma once

#include "core/contact/flank_contact.h"
#include "core/study/figure_limits.h"
#include "core/study/operating_point.h"
#include "core/study/speed_sweep.h"
#include "tribodyn/v1/campaigns.pb.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/points.pb.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// Converts every field of a solved contact and adds the model version.
v1::EvaluateContactResponse to_message(const ContactSolution& solution);

/// Sets level and summary of a warning by its code.
template <class Warning>  // v1::RangeWarning, v1::PointWarning or v1::CandidateWarning
void set_kind(Warning& warning);

v1::RangeWarning to_message(const RangeWarning& warning);

/// Converts warnings and adds them.
void add_warnings(const std::vector<RangeWarning>& warnings,
                  google::protobuf::RepeatedPtrField<v1::RangeWarning>* out);

/// Converts a limit and the name of its figure.
v1::FigureLimit to_message(const FigureLimit& limit);

/// Converts the name of a model.
v1::PointModel to_message(PointModel model);

/// Converts a point with its first `maximum_contact_losses` contact losses and the number of the
/// others.
v1::PointResult to_message(const PointResult& result, int maximum_contact_losses);

/// Converts a single point to a point of a curve.
v1::CurvePoint to_curve_point(const PointResult& result);
/// Converts one point of a curve: its speed in km/h with its result or the reason of its refusal.
v1::CurvePoint to_curve_point(const SweepPoint& point);

/// Converts m/s to km/h and rounds to 12 significant digits, so that 67.5 km/h in a request is 67.5
/// km/h in the answer.
double kilometres_per_hour(double metres_per_second);

}  // namespace tribodyn::server

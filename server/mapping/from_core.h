#pragma once

#include "core/contact/flank_contact.h"
#include "core/study/operating_point.h"
#include "core/study/speed_sweep.h"
#include "tribodyn/v1/contacts.pb.h"
#include "tribodyn/v1/results.pb.h"

namespace tribodyn::server {

/// Every field of a solved contact, with the model version.
v1::EvaluateContactResponse to_message(const ContactSolution& solution);

/// A point with at most `maximum_contact_losses` of its contact losses; the rest are counted.
v1::PointResult to_message(const PointResult& result, int maximum_contact_losses);

/// A single point as a curve of one.
v1::CurvePoint to_curve_point(const PointResult& result);
/// One place on a curve: speeds in km/h, result or refusal.
v1::CurvePoint to_curve_point(const SweepPoint& point);

/// m/s to km/h, rounded to 12 significant digits so that a stated 67.5 km/h comes back as 67.5.
double kilometres_per_hour(double metres_per_second);

}  // namespace tribodyn::server

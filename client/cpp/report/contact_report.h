#pragma once

#include <string>

#include "tribodyn/v1/contacts.pb.h"

namespace tribodyn::client {

/// Every quantity of one contact with symbol, value, unit and equation of the paper.
std::string contact_report(const v1::EvaluateContactResponse& contact);

}  // namespace tribodyn::client

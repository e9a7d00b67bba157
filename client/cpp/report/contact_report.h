#pragma once

#include <string>

#include "tribodyn/v1/contacts.pb.h"

namespace tribodyn::client {

/// Returns a table of every quantity of one contact: symbol, value, unit and equation of the paper.
std::string contact_report(const v1::EvaluateContactResponse& contact);

}  // namespace tribodyn::client

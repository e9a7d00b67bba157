#pragma once

#include <gmock/gmock.h>

#include <limits>
#include <string>

#include "server/contract/violations.h"
#include "server/simulation/contact_inputs.h"
#include "server/simulation/simulation_inputs.h"
#include "tests/service/support.h"

namespace tribodyn::server {

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Matches violations of which one names the field and has the text in its description.
inline auto violation(const std::string& field, const std::string& text) {
  return testing::Contains(
      testing::AllOf(testing::Field(&Violation::field, field),
                     testing::Field(&Violation::description, testing::HasSubstr(text))));
}

/// Return the violations of a request, with the seeds as the only resources.
inline Violations check(const v1::Simulation& simulation) {
  Violations violations;
  read_simulation(simulation, seed_lookup(), "simulation", violations);
  return violations;
}
inline Violations check(const v1::EvaluateContactRequest& request) {
  Violations violations;
  read_contact(request, seed_lookup(), violations);
  return violations;
}

}  // namespace tribodyn::server

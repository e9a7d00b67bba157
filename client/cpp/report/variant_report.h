#pragma once

#include <string>
#include <utility>
#include <vector>

#include "client/cpp/text/inputs.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// A curve, and another one of the same lubricant, surface and sump temperature by another model or
/// sweep.
struct Variant {
  const v1::Simulation* base;  ///< the first curve of these inputs
  const v1::Simulation* other;
  std::size_t index;  ///< of the other among all simulations
};
/// Returns the variants among curves, in their order. The pointers are into `simulations`.
std::vector<Variant> variants_of(const std::vector<v1::Simulation>& simulations);

/// Returns a label for each curve: the inputs that differ between the curves; for a variant, the
/// options that differ from those of its base, e.g. "sump 90 C, isothermal". A label is empty if
/// nothing differs.
std::vector<std::string> variant_notes(const std::vector<v1::Simulation>& simulations,
                                       const char* celsius = "C");

/// Returns the speeds [km/h] at which both curves have an energy mean, with its difference in
/// percent of that of the base.
std::vector<std::pair<double, double>> relative_differences(const Variant& variant);

/// Returns a table for each base: its energy mean at each speed, and the difference of each variant
/// in percent of it. Empty if there is no variant.
std::string variant_report(const std::vector<v1::Simulation>& simulations);

}  // namespace tribodyn::client

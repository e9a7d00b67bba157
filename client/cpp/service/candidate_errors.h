#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "client/cpp/report/screening.h"
#include "tribodyn/client/connection.h"

namespace tribodyn::client {

/// A standard uncertainty that the command line states for a parameter.
struct StatedUncertainty {
  const google::protobuf::FieldDescriptor* field;
  double value;              ///< in the unit of the field, or of the value of the parameter
  bool is_relative = false;  ///< `value` is a share of the value of the parameter
};

/// A parameter with a standard uncertainty.
struct UncertainInput {
  const google::protobuf::FieldDescriptor* field;
  /// All candidates have the value of the base, and its error in common. Otherwise the errors of
  /// different candidates are independent.
  bool is_shared;
  std::vector<double> uncertainties;  ///< by candidate, in the unit of the field
};

/// Returns the parameters with standard uncertainties: those in which candidates differ as columns
/// or `stated` say, and those of the base as `stated` or the base say. The uncertainties that the
/// base has of its laws of viscosity and density are left out: their parameters err together, and
/// all candidates have them in common.
std::vector<UncertainInput> uncertain_inputs(const Screening& screening,
                                             const std::vector<StatedUncertainty>& stated);

/// Returns the changes of the weighted mean inefficiency of candidates when one input rises by its
/// standard uncertainty [%]: half the difference of both directions, by candidate in the order of
/// `candidates`, then by input. NaN where the model refuses one of them.
std::vector<std::vector<double>> input_effects(Connection& connection, const Screening& screening,
                                               const v1::Schema& schema,
                                               const std::vector<UncertainInput>& inputs,
                                               const std::vector<std::size_t>& candidates);

}  // namespace tribodyn::client

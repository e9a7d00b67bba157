#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tribodyn {

/// One figure of a benchmark.
struct Measurement {
  std::string name;
  double value;
  std::string unit;
  std::optional<double> target;  ///< none: for information
  bool at_most = true;           ///< the target is met at or below it; otherwise at or above it
};

/// Whether it has no target or meets it.
bool is_met(const Measurement& measurement);

/// Enters figures into the list of {name, value, unit, target, met, machine} in a JSON file, made
/// if it is not there. A figure of the same name is replaced, others stay: several benchmarks,
/// also at the same time, may write to one file (it is locked, and replaced as a whole).
void record(const std::string& path, const std::vector<Measurement>& measurements);

/// A table for people.
void print(const std::vector<Measurement>& measurements);

/// What the figures were measured on: the processor's name, the number of processors, and the
/// instruction set that the vector code of the core uses by default.
std::string machine_name();

/// Processor time of this process so far [s].
double processor_seconds();

double median(std::vector<double> values);

}  // namespace tribodyn

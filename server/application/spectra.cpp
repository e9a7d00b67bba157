#include "server/application/spectra.h"

#include <fmt/format.h>
#include <google/protobuf/arena.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/study/order_spectrum.h"
#include "server/application/errors.h"
#include "server/application/stored_history.h"
#include "server/contract/check_message.h"
#include "server/mapping/history_columns.h"
#include "server/simulation/solver_defaults.h"

namespace tribodyn::server {
namespace {

constexpr double kDefaultMaximumOrder = 20;
constexpr double kMaximumAmplitudes = 100'000;
constexpr long kMaximumTransformedSamples = 1 << 20;

/// The part of a history that is transformed.
struct TransformedPart {
  int mesh_cycles = 0;
  int samples_per_mesh_cycle = 0;
  bool is_periodic = true;

  long samples() const { return static_cast<long>(mesh_cycles) * samples_per_mesh_cycle; }
  /// Amplitudes up to an order, at most half the samples.
  double lines(double order) const {
    return std::min(std::floor(order * mesh_cycles + 1e-9),
                    std::floor(0.5 * static_cast<double>(samples())));
  }
};

/// Mesh cycles that the history holds, and how many of them are a period.
TransformedPart part_of(const v1::HistoryRequest& history, const v1::PointResult& result) {
  TransformedPart out;
  out.samples_per_mesh_cycle = history.samples_per_mesh_cycle() == 0
                                   ? kDefaultHistorySamples
                                   : history.samples_per_mesh_cycle();
  const int cycles = history.mesh_cycles() == 0 ? kDefaultHistoryCycles : history.mesh_cycles();
  const bool is_quasi_static = result.model() == v1::POINT_MODEL_QUASI_STATIC;
  const int period = is_quasi_static ? 1 : result.period_in_mesh_cycles();
  out.is_periodic = period > 0;
  out.mesh_cycles = out.is_periodic ? period : cycles;
  return out;
}

/// Returns the places of the columns; none in the request: all but time and mesh phase.
std::vector<std::size_t> transformed_columns(const v1::ReadSpectrumRequest& request,
                                             const HistoryShape& shape, Violations& violations) {
  std::vector<std::size_t> out = history_places(request.columns(), shape, violations);
  if (!request.columns().empty()) return out;
  for (std::size_t place = 0; place < shape.names.size(); ++place) {
    if (shape.names[place] != history_column_name(HistoryColumn::kTime) &&
        shape.names[place] != history_column_name(HistoryColumn::kMeshPhase)) {
      out.push_back(place);
    }
  }
  return out;
}

google::rpc::Status history_unsuitable(const std::string& name, const std::string& why) {
  return not_possible(v1::ERROR_REASON_HISTORY_UNSUITABLE, "tribodyn.v1.Simulation", name,
                      name + " " + why);
}

}  // namespace

Outcome<v1::ReadSpectrumResponse> read_spectrum(Application& application,
                                                const v1::ReadSpectrumRequest& request,
                                                const CallContext& call) {
  Violations violations;
  check_message(request, "", violations);
  if (!violations.empty()) return invalid(violations);
  const auto found = find_history(application, request.name(), call);
  if (!found.ok()) return found.error();
  const auto& [stored, result_bytes, shape] = found.message();
  const std::vector<std::size_t> columns = transformed_columns(request, shape, violations);

  google::protobuf::Arena arena;  // a result has hundreds of parts
  auto& simulation = *google::protobuf::Arena::CreateMessage<v1::Simulation>(&arena);
  auto& result = *google::protobuf::Arena::CreateMessage<v1::SimulationResult>(&arena);
  simulation.ParseFromString(stored.request);
  result.ParseFromString(result_bytes);
  const v1::PointResult& point =
      result.points().empty() ? v1::PointResult::default_instance() : result.points(0).result();
  const TransformedPart part = part_of(simulation.operating_point().history(), point);
  const double order =
      request.maximum_order() == 0 ? kDefaultMaximumOrder : request.maximum_order();
  const double lines = part.lines(order);
  if (lines * static_cast<double>(columns.size()) > kMaximumAmplitudes) {
    violations.push_back(
        {"maximum_order", fmt::format("{} orders of {} columns; allowed: at most {} amplitudes",
                                      lines, columns.size(), kMaximumAmplitudes)});
  }
  if (!violations.empty()) return invalid(violations);
  if (part.samples() > shape.rows) {
    return history_unsuitable(
        request.name(), fmt::format("repeats after {0} mesh cycles, and its history holds fewer; "
                                    "compute it with history.mesh_cycles = {0}",
                                    part.mesh_cycles));
  }
  if (part.samples() > kMaximumTransformedSamples ||
      transform_products(part.samples()) > kMostTransformProducts) {
    return history_unsuitable(
        request.name(),
        fmt::format("has a history of {} samples to transform; allowed: at most {}, and fewer if "
                    "their number has large prime factors. Compute it with another "
                    "history.samples_per_mesh_cycle, e.g. 192",
                    part.samples(), kMaximumTransformedSamples));
  }

  v1::ReadSpectrumResponse out;
  for (int k = 1; k <= static_cast<int>(lines); ++k) {
    out.add_orders(static_cast<double>(k) / part.mesh_cycles);
  }
  std::vector<double> samples(static_cast<std::size_t>(part.samples()));
  for (const std::size_t place : columns) {
    if (call.limits.are_over()) return call_over(call.limits);
    if (!application.store.read_history(shape.columns[place], 0, 0, samples, call.limits)) {
      return history_evicted(request.name());
    }
    const OrderSpectrum spectrum = order_spectrum(samples, static_cast<std::size_t>(lines));
    v1::OrderSpectrum& column = *out.add_columns();
    column.set_name(shape.names[place]);
    column.set_unit(std::string(history_column_unit(shape.names[place])));
    column.set_mean(spectrum.mean);
    column.set_alternating_root_mean_square_value(std::sqrt(spectrum.alternating_mean_square));
    column.mutable_amplitudes()->Add(spectrum.amplitudes.begin(), spectrum.amplitudes.end());
    column.mutable_phase_angles_radians()->Add(spectrum.phase_angles.begin(),
                                               spectrum.phase_angles.end());
  }
  out.set_mesh_cycles(part.mesh_cycles);
  out.set_samples_per_mesh_cycle(part.samples_per_mesh_cycle);
  out.set_is_periodic(part.is_periodic);
  out.set_mesh_frequency_hertz(point.mesh_frequency_hertz());
  out.set_model_version(result.model_version());
  *out.mutable_input_warnings() = result.input_warnings();
  return out;
}

}  // namespace tribodyn::server

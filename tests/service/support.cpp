#include "tests/service/support.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "core/refusal.h"
#include "google/rpc/error_details.pb.h"
#include "server/application/simulations.h"
#include "server/storage/seeds.h"

namespace tribodyn::server {
namespace {

// Silences the log. It also creates spdlog's registry before any thread starts, as in the server:
// ThreadSanitizer does not see into the library and would report its first use in a thread as a
// race.
[[maybe_unused]] const bool kQuiet = [] {
  spdlog::set_level(spdlog::level::off);
  return true;
}();

constexpr auto kPollInterval = std::chrono::milliseconds(2);

PointResult made_up_point(double vehicle_speed, const HistoryRequest& history) {
  PointResult out;
  out.vehicle_speed = vehicle_speed;
  out.inefficiency_rms = 1.5;
  out.settled = true;
  const int rows = history.mesh_cycles * history.samples_per_mesh_cycle;
  for (const HistoryColumn column : history.columns) {
    const int copies = is_per_flank(column) ? kFlankPairs : 1;
    for (int k = 0; k < copies; ++k) {
      std::string name(history_column_name(column));
      if (copies > 1) name += "_flank_" + std::to_string(k);
      out.history.names.push_back(std::move(name));
      std::vector<double>& values = out.history.values.emplace_back();
      for (int i = 0; i < rows; ++i) values.push_back(1000.0 * k + i);
    }
  }
  return out;
}

/// Returns spdlog's default logger, which writes to the terminal.
std::shared_ptr<spdlog::logger>& usual_logger() {
  static std::shared_ptr<spdlog::logger> logger = spdlog::default_logger();
  return logger;
}

}  // namespace

LogCapture::LogCapture() {
  usual_logger();
  auto logger = std::make_shared<spdlog::logger>(
      "capture", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_, true));
  logger->set_level(spdlog::level::debug);
  spdlog::set_default_logger(std::move(logger));
}

LogCapture::~LogCapture() { spdlog::set_default_logger(usual_logger()); }

std::vector<std::string> complaint_lines(const google::rpc::Status& refusal) {
  std::vector<std::string> out;
  for (const auto& any : refusal.details()) {
    google::rpc::BadRequest bad;
    if (!any.UnpackTo(&bad)) continue;
    for (const auto& each : bad.field_violations()) {
      out.push_back(each.field() + ": " + each.description());
    }
  }
  return out;
}

std::string complaints(const google::rpc::Status& refusal) {
  std::string out;
  for (const std::string& line : complaint_lines(refusal)) out += line + "\n";
  return out;
}

SchemaSteps two_schemas() {
  SchemaSteps out = schema_steps();
  out.push_back(
      {"CREATE TABLE body_lengths (revision INTEGER PRIMARY KEY REFERENCES revisions (id), "
       "bytes INTEGER NOT NULL) STRICT",
       [](Connection& db) {
         db.exec("INSERT INTO body_lengths SELECT id, length(body) FROM revisions");
       },
       std::string(64, '2')});
  return out;
}

TemporaryFolder::TemporaryFolder(Kind kind) {
  const std::filesystem::path memory = "/dev/shm";
  const bool in_memory = kind == Kind::kMemory && access(memory.c_str(), W_OK) == 0;
  std::string name =
      ((in_memory ? memory : std::filesystem::temp_directory_path()) / "tribodyn-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

ResourceLookup seed_lookup() {
  static const std::vector<NewResource> kSeeds = seed_resources();
  return {[](const RevisionName& name) -> std::optional<FoundResource> {
            for (const NewResource& seed : kSeeds) {
              if (seed.name == name.name && name.revision <= 1) {
                return FoundResource{1, false, seed.body};
              }
            }
            return std::nullopt;
          },
          [](const std::string& collection) {
            std::vector<std::string> names;
            for (const NewResource& seed : kSeeds) {
              if (seed.name.starts_with(collection + "/")) names.push_back(seed.name);
            }
            return names;
          }};
}

v1::EvaluateContactRequest contact_request() {
  v1::EvaluateContactRequest out;
  out.set_load_newtons(2000);
  out.set_radius_x_metres(0.015);
  out.set_radius_y_metres(0.3);
  out.set_pinion_velocity_x_metres_per_second(5);
  out.set_pinion_velocity_y_metres_per_second(6);
  out.set_gear_velocity_x_metres_per_second(4);
  out.set_gear_velocity_y_metres_per_second(-1);
  out.set_lubricant("lubricants/paper-fluid-1");
  out.set_sump_temperature_celsius(40);
  out.set_inlet_temperature_rise_kelvin(20);
  out.set_youngs_modulus_pascals(206e9);
  out.set_poissons_ratio(0.3);
  out.set_solid_thermal_conductivity_watts_per_metre_kelvin(46);
  out.set_solid_density_kilograms_per_cubic_metre(7850);
  out.set_solid_specific_heat_capacity_joules_per_kilogram_kelvin(470);
  out.set_asperity_density_per_square_metre(5e9);
  out.set_asperity_radius_metres(1.5e-5);
  out.set_composite_rms_height_metres(5e-7);
  out.set_tribofilm_shear_strength_pascals(2e6);
  out.set_asperity_friction_coefficient(0.17);
  return out;
}

v1::Simulation point_simulation() {
  v1::Simulation out;
  out.set_lubricant("lubricants/paper-fluid-1");
  out.mutable_operating_point()->mutable_cruise()->set_speed_kilometres_per_hour(65);
  return out;
}

v1::Simulation curve_simulation() {
  v1::Simulation out;
  out.set_lubricant("lubricants/paper-fluid-2");
  v1::InefficiencyCurveStudy* curve = out.mutable_inefficiency_curve();
  curve->set_first_speed_kilometres_per_hour(20);
  curve->set_last_speed_kilometres_per_hour(140);
  curve->set_speed_step_kilometres_per_hour(10);
  return out;
}

v1::Simulation long_simulation(v1::SteadyStateMethod method) {
  v1::Simulation out = curve_simulation();
  v1::InefficiencyCurveStudy* curve = out.mutable_inefficiency_curve();
  curve->set_first_speed_kilometres_per_hour(60);
  curve->set_last_speed_kilometres_per_hour(80);
  curve->set_speed_step_kilometres_per_hour(0.0201);
  v1::SolverOptions* solver = out.mutable_solver_options();
  solver->set_method(method);
  solver->set_tolerance(1e-8);
  solver->set_march_step_tolerance(1e-11);
  solver->set_march_settling_tolerance(1e-12);
  solver->set_maximum_mesh_cycles(10000);
  return out;
}

StudyFunctions quick_studies() {
  StudyFunctions out;
  out.solve_operating_point = [](const Scene&, const OperatingCondition& condition,
                                 const PointOptions& options, const auto&) {
    return made_up_point(condition.vehicle_speed, options.history);
  };
  out.sweep_speed = [](const Scene&, const std::vector<double>& speeds, double, const SweepOptions&,
                       const std::function<void(const SweepPoint&)>& on_point, const auto&) {
    std::vector<SweepPoint> points;
    for (const double speed : speeds) {
      points.push_back({.vehicle_speed = speed,
                        .result = made_up_point(speed, {}),
                        .refusal_reason = "",
                        .refusal_sentence = "",
                        .branch_end = {}});
      on_point(points.back());
    }
    return points;
  };
  return out;
}

StudyFunctions patient_studies(const std::shared_ptr<std::atomic<bool>>& release) {
  const auto wait = [release](const std::function<bool(double)>& progress) {
    for (int step = 0; !*release; ++step) {
      if (!progress(step / (step + 100.0))) throw Cancelled();
      std::this_thread::sleep_for(kPollInterval);
    }
  };
  StudyFunctions out = quick_studies();
  out.solve_operating_point = [wait, inner = out.solve_operating_point](
                                  const Scene& scene, const OperatingCondition& condition,
                                  const PointOptions& options, const auto& gear_set) {
    wait(options.progress);
    return inner(scene, condition, options, gear_set);
  };
  out.sweep_speed = [wait, inner = out.sweep_speed](
                        const Scene& scene, const std::vector<double>& speeds, double angle,
                        const SweepOptions& options,
                        const std::function<void(const SweepPoint&)>& on_point,
                        const auto& gear_set) {
    wait(options.point.progress);
    return inner(scene, speeds, angle, options, on_point, gear_set);
  };
  return out;
}

bool eventually(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  while (std::chrono::steady_clock::now() < end) {
    if (condition()) return true;
    std::this_thread::sleep_for(kPollInterval);
  }
  return condition();
}

Bench::Bench(StudyFunctions studies, int threads, const QueueLimits& limits,
             std::chrono::milliseconds heartbeat)
    : threads_(threads), limits_(limits), heartbeat_(heartbeat) {
  open(std::move(studies));
}

void Bench::open(StudyFunctions studies) {
  store_ = std::make_unique<Store>(folder_.file("tribodyn.db"));
  store_->add_project("default", seed_resources(), system_time());
  SimulationJobs::Options options;
  options.threads = threads_;
  options.limits = limits_;
  options.studies = std::move(studies);
  options.heartbeat = heartbeat_;
  options.wants_proof = false;  // most studies are made up
  jobs_ = std::make_unique<SimulationJobs>(*store_, options);
  jobs_->resume();
  jobs_->start();
}

void Bench::restart(StudyFunctions studies) {
  jobs_->stop();
  jobs_.reset();
  store_.reset();
  open(std::move(studies));
}

std::string Bench::create(const v1::Simulation& simulation) {
  v1::CreateSimulationRequest request;
  *request.mutable_simulation() = simulation;
  return create(request);
}

std::string Bench::create(const v1::CreateSimulationRequest& request) {
  Application app = application();
  const auto outcome = create_simulation(app, request);
  if (!outcome.ok()) throw std::runtime_error(outcome.error().message());
  return outcome.message().name();
}

v1::Simulation Bench::get(const std::string& name) {
  v1::GetSimulationRequest request;
  request.set_name(name);
  Application app = application();
  const auto outcome = get_simulation(app, request);
  if (!outcome.ok()) throw std::runtime_error(outcome.error().message());
  return outcome.message();
}

bool Bench::reaches(const std::string& name, v1::Simulation::State state) {
  return eventually([&] { return get(name).state() == state; });
}

std::vector<double> history_rows(Store& store, std::int64_t simulation, const std::string& column,
                                 std::int64_t start, std::int64_t count) {
  const HistoryShape shape = store.history_shape(simulation);
  const auto found = std::find(shape.names.begin(), shape.names.end(), column);
  std::vector<double> values(static_cast<std::size_t>(count));
  if (found == shape.names.end() ||
      !store.read_history(shape.columns[static_cast<std::size_t>(found - shape.names.begin())], 0,
                          start, values)) {
    throw std::runtime_error("the history has no such column");
  }
  return values;
}

}  // namespace tribodyn::server

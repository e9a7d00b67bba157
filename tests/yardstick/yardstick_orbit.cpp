#include "yardstick_orbit.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace tribodyn::yardstick {
namespace {

// Running time integrals, integrated as extra states after the eight of the model.
enum IntegralIndex {
  kFrictionEnergy = kStateSize,  // int P dt
  kSquaredRatio,                 // int (P / P_in)^2 dt
  kIncomingEnergy,               // int P_in dt
  kTransmissionErrorIntegral,    // int (x - b) dt
  kPinionFrictionImpulse,        // int T_fr,p dt
  kVectorSize
};

constexpr double kSamplesPerCycle = 2000.0;  // least density of the samples for extremes

// Smallest and largest value of a sampled signal, with a parabola through three samples around
// every interior extremum. restart() where the signal has a kink or a jump.
class ExtremeTracker {
 public:
  void restart() { count_ = 0; }

  void add(double time, double value) {
    if (!std::isfinite(value)) {
      restart();
      return;
    }
    widen(value);
    if (count_ == 3) {
      std::copy(time_.begin() + 1, time_.end(), time_.begin());
      std::copy(value_.begin() + 1, value_.end(), value_.begin());
      count_ = 2;
    }
    if (count_ > 0 && !(time > time_[count_ - 1])) return;
    time_[count_] = time;
    value_[count_] = value;
    if (++count_ < 3) return;
    const double left = value_[0] - value_[1];
    const double right = value_[2] - value_[1];
    if (left * right <= 0.0) return;  // monotone
    const double a = time_[0] - time_[1];
    const double b = time_[2] - time_[1];
    const double curvature = (left / a - right / b) / (a - b);
    const double slope = left / a - curvature * a;
    widen(value_[1] - slope * slope / (4.0 * curvature));
  }

  double minimum() const { return minimum_; }
  double maximum() const { return maximum_; }

 private:
  void widen(double value) {
    minimum_ = std::min(minimum_, value);
    maximum_ = std::max(maximum_, value);
  }

  double minimum_ = std::numeric_limits<double>::infinity();
  double maximum_ = -std::numeric_limits<double>::infinity();
  int count_ = 0;
  std::array<double, 3> time_{};
  std::array<double, 3> value_{};
};

constexpr int kRootCount = 3;  // next table node; x = +-b on the watched side; mesh force

void check(int flag, const char* call) {
  if (flag < 0) throw std::runtime_error(std::string(call) + " failed: " + std::to_string(flag));
}

// Owns the SUNDIALS objects of one mesh cycle.
class CycleIntegrator {
 public:
  CycleIntegrator(const GearPairSystem& system, const State& start, double input_torque,
                  double resistive_torque, const CycleOptions& options)
      : system_(system), input_torque_(input_torque), resistive_torque_(resistive_torque) {
    check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    vector_ = N_VNew_Serial(kVectorSize, context_);
    absolute_tolerance_ = N_VNew_Serial(kVectorSize, context_);
    std::fill_n(data(vector_), static_cast<int>(kVectorSize), 0.0);
    std::copy(start.begin(), start.end(), data(vector_));
    mode_ = system.mode_of(start);
    set_tolerances(start, options.tolerance);

    cvode_ = CVodeCreate(CV_ADAMS, context_);
    check(CVodeInit(cvode_, right_hand_side, 0.0, vector_), "CVodeInit");
    check(CVodeSVtolerances(cvode_, 0.0, absolute_tolerance_), "CVodeSVtolerances");
    check(CVodeSetUserData(cvode_, this), "CVodeSetUserData");
    solver_ = SUNNonlinSol_FixedPoint(vector_, 0, context_);
    check(CVodeSetNonlinearSolver(cvode_, solver_), "CVodeSetNonlinearSolver");
    check(CVodeRootInit(cvode_, kRootCount, root_functions), "CVodeRootInit");
    check(CVodeSetNoInactiveRootWarn(cvode_), "CVodeSetNoInactiveRootWarn");
    check(CVodeSetMaxHnilWarns(cvode_, -1), "CVodeSetMaxHnilWarns");
    result_.input_torque = input_torque;
    dense_ = N_VNew_Serial(kVectorSize, context_);
  }

  ~CycleIntegrator() {
    CVodeFree(&cvode_);
    SUNNonlinSolFree(solver_);
    N_VDestroy(vector_);
    N_VDestroy(absolute_tolerance_);
    N_VDestroy(dense_);
    SUNContext_Free(&context_);
  }

  CycleIntegrator(const CycleIntegrator&) = delete;
  CycleIntegrator& operator=(const CycleIntegrator&) = delete;

  MeshCycle run() {
    double time = 0.0;
    while (interval_ < kIntervals) {
      const double segment_start = time;
      set_root_directions();
      for (ExtremeTracker* tracker : {&error_, &torque_, &temperature_, &film_, &pressure_}) {
        tracker->restart();
      }
      record(time, vector_);
      bool event = false;
      while (!event) {
        const double step_start = time;
        const int flag = CVode(cvode_, 1.0e9, vector_, &time, CV_ONE_STEP);
        check(flag, "CVode");
        record_inside(step_start, time);
        record(time, vector_);
        event = flag == CV_ROOT_RETURN;
        if (!(data(vector_)[kPinionSpeed] > 0.0)) throw std::runtime_error("the pinion stops");
      }
      if (mode_ == ContactMode::kSeparated) result_.separated_fraction += time - segment_start;
      pass_event();
      check(CVodeReInit(cvode_, time, vector_), "CVodeReInit");
    }
    finish(time);
    return result_;
  }

 private:
  static double* data(N_Vector vector) { return N_VGetArrayPointer(vector); }

  static State state_of(N_Vector vector) {
    State state;
    std::copy_n(data(vector), static_cast<int>(kStateSize), state.begin());
    return state;
  }

  void set_tolerances(const State& start, double tolerance) {
    const double backlash = system_.gear_pair().half_backlash;
    const double shaft_speed = start[kPinionShaftSpeed];
    const double period = 2.0 * std::numbers::pi / system_.gear_pair().pinion_teeth / shaft_speed;
    const double torque = std::max(std::abs(input_torque_), 1.0);
    const double power = 0.01 * torque * shaft_speed;
    double* scale = data(absolute_tolerance_);
    scale[kPinionShaftTwist] = torque / system_.gear_pair().pinion_shaft_stiffness;
    scale[kPinionAngle] = 0.1;
    scale[kMeshAdvance] = 0.1 * backlash;
    scale[kGearShaftTwist] = torque / system_.gear_pair().gear_shaft_stiffness;
    for (int i = kPinionShaftSpeed; i <= kGearShaftSpeed; ++i) scale[i] = 1.0;
    scale[kFrictionEnergy] = power * period;
    scale[kSquaredRatio] = std::pow(0.01, 2) * period;
    scale[kIncomingEnergy] = torque;
    scale[kTransmissionErrorIntegral] = backlash * period;
    scale[kPinionFrictionImpulse] = 0.01 * torque * period;
    for (int i = 0; i < kVectorSize; ++i) scale[i] *= tolerance;
  }

  Instant evaluate_at(N_Vector vector) const {
    return system_.evaluate(state_of(vector), interval_, mode_, input_torque_, resistive_torque_);
  }

  static int right_hand_side(double, N_Vector vector, N_Vector rate, void* user_data) {
    auto* self = static_cast<CycleIntegrator*>(user_data);
    const Instant now = self->evaluate_at(vector);
    // Power comes in at the shaft that drives: at the pinion's in drive, at the wheel's in coast.
    const double power_in = std::max(self->input_torque_ * data(vector)[kPinionShaftSpeed], 0.0) +
                            std::max(-self->resistive_torque_ * data(vector)[kGearShaftSpeed], 0.0);
    double* out = data(rate);
    std::copy(now.rate.begin(), now.rate.end(), out);
    out[kFrictionEnergy] = now.friction_power;
    out[kSquaredRatio] = std::pow(now.friction_power / power_in, 2);
    out[kIncomingEnergy] = power_in;
    out[kTransmissionErrorIntegral] =
        now.transmission_error - self->system_.gear_pair().half_backlash;
    out[kPinionFrictionImpulse] = now.pinion_friction_torque;
    ++self->result_.right_hand_sides;
    return 0;
  }

  bool coast_side() const {
    return mode_ == ContactMode::kCoastLoaded || mode_ == ContactMode::kCoastUnloaded;
  }

  static int root_functions(double, N_Vector vector, double* roots, void* user_data) {
    auto* self = static_cast<CycleIntegrator*>(user_data);
    const double backlash = self->system_.gear_pair().half_backlash;
    const State state = state_of(vector);
    // Friction plays no part here: evaluate in the unloaded mode of the same side.
    ContactMode mode = self->mode_;
    if (mode == ContactMode::kDriveLoaded) mode = ContactMode::kDriveUnloaded;
    if (mode == ContactMode::kCoastLoaded) mode = ContactMode::kCoastUnloaded;
    const Instant now = self->system_.evaluate(state, 0, mode, 0.0, 0.0);
    const double x = now.transmission_error;
    roots[0] = state[kPinionAngle] - self->system_.pinion_angle_at_node(self->interval_ + 1);
    roots[1] = self->coast_side() ? x + backlash : x - backlash;
    roots[2] = mode == ContactMode::kSeparated ? x + backlash : now.mesh_force;
    return 0;
  }

  // Only crossings that leave the present mode count.
  void set_root_directions() {
    int directions[kRootCount] = {1, 0, 0};
    switch (mode_) {
      case ContactMode::kDriveLoaded:
        directions[1] = directions[2] = -1;
        break;
      case ContactMode::kDriveUnloaded:
        directions[1] = -1;
        directions[2] = 1;
        break;
      case ContactMode::kSeparated:
        directions[1] = 1;   // x = b rising
        directions[2] = -1;  // x = -b falling
        break;
      case ContactMode::kCoastLoaded:
        directions[1] = directions[2] = 1;
        break;
      case ContactMode::kCoastUnloaded:
        directions[1] = 1;
        directions[2] = -1;
        break;
    }
    check(CVodeSetRootDirection(cvode_, directions), "CVodeSetRootDirection");
  }

  void pass_event() {
    int roots[kRootCount];
    check(CVodeGetRootInfo(cvode_, roots), "CVodeGetRootInfo");
    if (roots[1] != 0 || roots[2] != 0) ++result_.mode_changes;
    if (roots[1] != 0) {
      mode_ =
          mode_ == ContactMode::kSeparated ? ContactMode::kDriveLoaded : ContactMode::kSeparated;
    } else if (roots[2] != 0) {
      switch (mode_) {
        case ContactMode::kDriveLoaded:
          mode_ = ContactMode::kDriveUnloaded;
          break;
        case ContactMode::kDriveUnloaded:
          mode_ = ContactMode::kDriveLoaded;
          break;
        case ContactMode::kCoastLoaded:
          mode_ = ContactMode::kCoastUnloaded;
          break;
        case ContactMode::kSeparated:
        case ContactMode::kCoastUnloaded:
          mode_ = ContactMode::kCoastLoaded;
          break;
      }
    }
    if (roots[0] != 0) ++interval_;
  }

  void record(double time, N_Vector vector) {
    const Instant now = evaluate_at(vector);
    error_.add(time, now.transmission_error);
    torque_.add(time, now.pinion_friction_torque);
    temperature_.add(time, now.maximum_temperature);
    film_.add(time, now.minimum_film_parameter);
    pressure_.add(time, now.maximum_pressure);
  }

  // Dense output inside the step just taken.
  void record_inside(double start, double end) {
    const double spacing = 2.0 * std::numbers::pi / system_.gear_pair().pinion_teeth /
                           data(vector_)[kPinionSpeed] / kSamplesPerCycle;
    const int pieces = static_cast<int>(std::ceil((end - start) / spacing));
    for (int piece = 1; piece < pieces; ++piece) {
      const double time = start + (end - start) * piece / pieces;
      check(CVodeGetDky(cvode_, time, 0, dense_), "CVodeGetDky");
      record(time, dense_);
    }
  }

  void finish(double time) {
    const double* components = data(vector_);
    State end = state_of(vector_);
    end[kPinionAngle] = 0.0;  // u is unchanged: R_p0 / N_p = R_g0 / N_g
    result_.end = {end[kPinionShaftTwist],
                   end[kGearShaftTwist],
                   end[kPinionShaftSpeed],
                   end[kPinionSpeed],
                   end[kGearSpeed],
                   end[kGearShaftSpeed],
                   system_.advance_with_error(end)};
    result_.period = time;
    result_.vehicle_speed = system_.vehicle().wheel_radius * 2.0 * std::numbers::pi /
                            system_.gear_pair().gear_teeth / time;
    result_.rms_inefficiency = 100.0 * std::sqrt(components[kSquaredRatio] / time);
    result_.energy_mean_inefficiency =
        100.0 * components[kFrictionEnergy] / components[kIncomingEnergy];
    result_.transmission_error.mean =
        system_.gear_pair().half_backlash + components[kTransmissionErrorIntegral] / time;
    result_.pinion_friction_torque.mean = components[kPinionFrictionImpulse] / time;
    result_.separated_fraction /= time;
    result_.transmission_error.minimum = error_.minimum();
    result_.transmission_error.maximum = error_.maximum();
    result_.pinion_friction_torque.minimum = torque_.minimum();
    result_.pinion_friction_torque.maximum = torque_.maximum();
    result_.maximum_temperature = temperature_.maximum();
    result_.minimum_film_parameter = film_.minimum();
    result_.maximum_pressure = pressure_.maximum();
  }

  const GearPairSystem& system_;
  double input_torque_;
  double resistive_torque_;
  int interval_ = 0;
  ContactMode mode_ = ContactMode::kSeparated;
  MeshCycle result_;
  ExtremeTracker error_;
  ExtremeTracker torque_;
  ExtremeTracker temperature_;
  ExtremeTracker film_;
  ExtremeTracker pressure_;
  SUNContext context_ = nullptr;
  N_Vector vector_ = nullptr;
  N_Vector absolute_tolerance_ = nullptr;
  N_Vector dense_ = nullptr;
  void* cvode_ = nullptr;
  SUNNonlinearSolver solver_ = nullptr;
};

}  // namespace

MeshCycle integrate_mesh_cycle(const GearPairSystem& system, const SectionState& start,
                               double input_torque, double resistive_torque,
                               const CycleOptions& options) {
  const State state = {start.pinion_shaft_twist,
                       0.0,
                       system.mesh_advance_at_section(start.advance_with_error),
                       start.gear_shaft_twist,
                       start.pinion_shaft_speed,
                       start.pinion_speed,
                       start.gear_speed,
                       start.gear_shaft_speed};
  CycleIntegrator integrator(system, state, input_torque, resistive_torque, options);
  return integrator.run();
}

}  // namespace tribodyn::yardstick

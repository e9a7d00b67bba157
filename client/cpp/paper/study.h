#pragma once

#include <map>
#include <string>
#include <vector>

#include "tribodyn/v1/gear_sets.pb.h"
#include "tribodyn/v1/rigs.pb.h"
#include "tribodyn/v1/simulations.pb.h"

namespace tribodyn::client {

/// Returns the speeds of a figure from 20 to `last` [km/h]: close enough around the resonance to
/// find the edges of contact loss to half a kilometre per hour, and around half of its speed to
/// show the second harmonic.
std::vector<double> paper_speeds(double last = 140);

/// A curve over speed of a figure of the paper: cruise on a level road with run-in flanks
/// and the passenger car.
struct PaperCurve {
  int fluid = 1;  ///< of the paper, 1 to 3
  double sump_temperature_celsius = 40;
  /// Fields of ModelOptions that are on in addition to the preset PAPER, e.g. "isothermal",
  /// "as_published.eq20_semi_major".
  std::vector<std::string> switches = {};
  bool is_down_sweep = false;
  std::string gear_set = "reference-axle";
  /// Speeds [km/h]; empty: paper_speeds().
  std::vector<double> speeds = {};
};
v1::Simulation simulation_of(const PaperCurve& curve);

/// A ball on a disc.
struct PaperRig {
  std::string lubricant;
  double ball_radius_metres;
  bool has_glass_disc;
  double supply_temperature_celsius;
  std::vector<double> loads_newtons;
  std::vector<double> speeds_metres_per_second;
  std::vector<double> slide_roll_ratios_percent;
  std::vector<std::string> switches = {};  ///< as in PaperCurve
};
/// Returns the request with every combination of loads, speeds and slide-roll ratios; the last
/// varies fastest.
v1::EvaluateRigRequest request_of(const PaperRig& rig);

/// A figure y of the points of a study over the swept quantity x, in ascending order of x.
struct PaperLine {
  std::vector<double> x, y;
  /// Returns y at a place of x. Throws std::out_of_range, naming x, if there is none.
  double at(double place) const;
  double largest() const;
  double least() const;
  /// Returns the place of the largest y.
  double place_of_largest() const;
};

/// Results of the studies of some figures.
class PaperResults {
 public:
  void add(const PaperCurve& curve, const v1::Simulation& simulation);
  void add(const PaperRig& rig, const v1::EvaluateRigResponse& response);
  void add(const v1::GearSet& gear_set) {
    half_backlash_ = gear_set.dynamics().half_backlash_metres();
  }

  // Throw std::out_of_range for a study that was not added.
  const v1::Simulation& of(const PaperCurve& curve) const;
  const v1::EvaluateRigResponse& of(const PaperRig& rig) const;

  /// Returns a figure of the points that have a result, against speed [km/h].
  template <class Value>
  PaperLine line(const PaperCurve& curve, Value value) const {
    PaperLine out;
    for (const v1::CurvePoint& point : of(curve).result().points()) {
      if (!point.has_result()) continue;
      out.x.push_back(point.speed_kilometres_per_hour());
      out.y.push_back(value(point.result()));
    }
    return out;
  }
  /// Returns traction coefficients against the slide-roll ratio [%] at one load.
  PaperLine traction(const PaperRig& rig, double load_newtons) const;
  /// Returns central film thicknesses [m] against speed [m/s].
  PaperLine film(const PaperRig& rig) const;

  double half_backlash_metres() const { return half_backlash_; }
  const std::string& model_version() const { return model_version_; }
  /// Returns the largest estimated relative error of any point of the curve.
  double largest_error(const PaperCurve& curve) const;

 private:
  double half_backlash_ = 0;  // [m]
  std::string model_version_;
  std::map<std::string, v1::Simulation> curves_;
  std::map<std::string, v1::EvaluateRigResponse> rigs_;
};

}  // namespace tribodyn::client

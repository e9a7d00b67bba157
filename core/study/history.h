#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribodyn {

/// What can be recorded against time. Per-flank columns exist for slots 0, 1, 2.
enum class HistoryColumn {
  kTime,                              ///< [s]
  kMeshPhase,                         ///< cycles from the section [-]
  kPinionShaftSpeed,                  ///< phidot_s [rad/s]
  kPinionSpeed,                       ///< phidot_p [rad/s]
  kGearSpeed,                         ///< phidot_g [rad/s]
  kWheelSpeed,                        ///< phidot_w [rad/s]
  kDynamicTransmissionError,          ///< x [m]
  kDynamicTransmissionErrorVelocity,  ///< xdot [m/s]
  kMeshForce,                         ///< k_m f + c xdot [N]
  kPinionShaftTorque,                 ///< k_t1 (phi_s - phi_p) + c_t1 (...) [N m]
  kGearShaftTorque,                   ///< k_t2 (phi_g - phi_w) + c_t2 (...) [N m]
  kPinionFrictionTorque,              ///< [N m]
  kGearFrictionTorque,                ///< [N m]
  kMeshLossPower,                     ///< sum V_s F_fr [W]
  kInefficiency,                      ///< eq 30, instantaneous, of the power that comes in [%]
  kFlankLoad,                         ///< from here on: one column per slot [N]
  kFlankFriction,                     ///< [N]
  kFlankViscousFriction,              ///< [N]
  kFlankBoundaryFriction,             ///< [N]
  kFlankFilmThickness,                ///< [m]
  kFlankFilmRatio,                    ///< [-]
  kFlankContactTemperature,           ///< [K]
  kFlankMaximumPressure,              ///< [Pa]
  kFlankShearRate,                    ///< [1/s]
  kFlankSlidingSpeed,                 ///< [m/s]
  kFlankFrictionCoefficient,          ///< F_fr/W [-]
  kFlankFlashTemperatureRise,         ///< (dT_f)_av, eq 39 [K]
  kFlankPinionSpecificSliding,        ///< [-]
  kFlankGearSpecificSliding,          ///< [-]
  kFlankEntrainmentSpeed,             ///< U_eff, eq 17 [m/s]
  kFlankMeanShearStress,              ///< area mean of eq 23 under the limit [Pa]
  kFlankLimitingStressAreaShare,      ///< share of the contact area on the limiting stress [-]
  kFlankAsperityLoad,                 ///< W_asp, eq 41 [N]
};

inline constexpr int kHistoryColumns = static_cast<int>(HistoryColumn::kFlankAsperityLoad) + 1;

bool is_per_flank(HistoryColumn column);
/// e.g. "dynamic_transmission_error_metres", "flank_load_newtons"; unit suffix included.
std::string_view history_column_name(HistoryColumn column);

struct HistoryRequest {
  std::vector<HistoryColumn> columns;  ///< empty: no history
  int mesh_cycles = 1;                 ///< of the steady state [1, 1000]
  int samples_per_mesh_cycle = 192;    ///< equidistant in mesh phase [2, 100000]
};

/// Column-major: values[c] has one entry per sample. Per-flank columns appear three times, names
/// ending in "_flank_0" .. "_flank_2". A flank without load has zero for every quantity.
struct History {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

}  // namespace tribodyn

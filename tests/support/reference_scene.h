#pragma once

#include <string>
#include <vector>

#include "core/study/scene.h"
#include "tests/support/reference_data.h"

namespace tribodyn {

inline FourierSeries reference_series(const nlohmann::json& block) {
  return {block.at("c0"), block.at("sin"), block.at("cos")};
}

inline MeshSeries reference_mesh_series(const nlohmann::json& block) {
  return {reference_series(block.at("R_p")), reference_series(block.at("R_g")),
          reference_series(block.at("k_m")), reference_series(block.at("e"))};
}

inline SlotTable reference_slots(const nlohmann::json& table) {
  SlotTable out;
  for (int k = 0; k < kFlankPairs; ++k) out[k] = table.at(k).get<std::vector<double>>();
  return out;
}

inline DrivelineDynamics reference_dynamics(const nlohmann::json& d) {
  return {d.at("I_s"),  d.at("I_p"),  d.at("I_g"),  d.at("I_w"),    d.at("k_t1"),
          d.at("k_t2"), d.at("c_t1"), d.at("c_t2"), d.at("c_mesh"), d.at("b")};
}

/// Returns gear set A or B of reference_gear_set.json.
inline GearSet reference_gear_set(const std::string& calibration = "A") {
  const nlohmann::json file = load_reference("reference_gear_set.json");
  GearSet out;
  out.pinion_teeth = file.at("blank_geometry").at("N_p");
  out.gear_teeth = file.at("blank_geometry").at("N_g");
  const nlohmann::json& t = file.at("tables");
  out.tables = {reference_slots(t.at("load_share")),
                reference_slots(t.at("Rx")),
                reference_slots(t.at("Ry")),
                reference_slots(t.at("A_up")),
                reference_slots(t.at("A_vp")),
                reference_slots(t.at("A_ug")),
                reference_slots(t.at("A_vg")),
                reference_slots(t.at("A_contact_minor")),
                reference_slots(t.at("A_contact_major")),
                reference_slots(t.at("r_fr_p")),
                reference_slots(t.at("r_fr_g"))};
  const nlohmann::json& own = calibration == "B" ? file.at("calibration_B") : file;
  out.series = reference_mesh_series(own.at("fourier"));
  out.dynamics = reference_dynamics(own.at("dynamics"));
  if (calibration == "A") {
    const nlohmann::json& by_torque = file.at("fourier_by_torque");
    for (std::size_t i = 0; i < by_torque.at("torques").size(); ++i) {
      out.series_by_torque.push_back(
          {by_torque.at("torques").at(i), reference_mesh_series(by_torque.at("sets").at(i))});
    }
    const nlohmann::json& shares = file.at("load_share_by_torque");
    for (std::size_t i = 0; i < shares.at("torques").size(); ++i) {
      out.load_share_by_torque.push_back(
          {shares.at("torques").at(i), reference_slots(shares.at("load_share").at(i))});
    }
  }
  return out;
}

/// Returns fluid 1, 2 or 3 of the paper.
inline Lubricant reference_lubricant(int fluid = 1) {
  Lubricant oil{1.55e-4, 944.8,  159, 1.609e-8, 313.15, 4.5e-7, 0.9,
                0.25,    343.15, 4e6, 0.029,    0.154,  1016.1, -0.6323};
  if (fluid == 2) {
    oil.vogel_viscosity_prefactor = 7.47e-5;
    oil.vogel_temperature_coefficient = 1105.0;
    oil.vogel_reference_temperature = 157;
    oil.pressure_viscosity_coefficient = 1.931e-8;
  } else if (fluid == 3) {
    oil.vogel_viscosity_prefactor = 1.34e-4;
    oil.vogel_temperature_coefficient = 943.0;
    oil.vogel_reference_temperature = 160;
    oil.pressure_viscosity_coefficient = 1.627e-8;
  }
  return oil;
}

/// Returns the default scene: a fluid on gear set A or B, passenger car, sump temperature in
/// Celsius.
inline Scene reference_scene(int fluid = 1, double sump_celsius = 40,
                             const std::string& calibration = "A") {
  return {reference_lubricant(fluid),
          reference_gear_set(calibration),
          {2.5e9, 40e-6, 0.4e-6},
          {2e6, 0.17},
          {206e9, 0.3, 46, 7850, 470},
          {1300, 0.0125, 0.3, 2.2, 1.225, 0.28, 9.81},
          sump_celsius + 273.15,
          20,
          {}};
}

}  // namespace tribodyn

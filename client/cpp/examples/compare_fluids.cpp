// An example of the client library: prints what two gear oils cost at one speed and which
// parameters are assumed. usage: compare_fluids HOST:PORT [LUBRICANT LUBRICANT]
#include <tribodyn/client/connection.h>

#include <cstdlib>
#include <iostream>

namespace {

using namespace tribodyn;

/// Returns a fluid of which only a data sheet is known; the server estimates the other parameters.
v1::Lubricant fluid_of_a_data_sheet() {
  v1::Lubricant fluid;
  fluid.set_display_name("Data sheet: 103 and 15.1 mm2/s, 868 kg/m3");
  fluid.set_base_oil_class(v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN);
  auto& measured = *fluid.mutable_measurements();
  measured.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(103);
  measured.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(15.1);
  measured.set_density_15_celsius_kilograms_per_cubic_metre(868);
  return fluid;
}

v1::Simulation cruise(const std::string& lubricant) {
  v1::Simulation simulation;
  simulation.set_lubricant(lubricant);
  auto& study = *simulation.mutable_operating_point();
  study.mutable_cruise()->set_speed_kilometres_per_hour(50);
  study.set_model(v1::POINT_MODEL_QUASI_STATIC);
  return simulation;
}

void compare(client::Connection& connection, const std::vector<std::string>& lubricants) {
  for (const std::string& lubricant : lubricants) {
    const v1::Simulation job = connection.create_simulation(cruise(lubricant));
    const v1::Simulation ended = connection.wait_for_end(job.name());
    if (ended.state() != v1::Simulation::SUCCEEDED) {
      throw std::runtime_error(lubricant + ": " + ended.error().message());
    }
    std::cout << lubricant << ": " << ended.result().points(0).result().mesh_loss_power_watts()
              << " W\n";
    for (const auto& assumption : ended.result().assumptions()) {
      if (assumption.provenance() != v1::PROVENANCE_ASSUMED) continue;
      std::cout << "  assumed: " << assumption.resource() << " " << assumption.field() << " = "
                << assumption.value() << "\n";
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    client::Connection connection(client::server_address(argc > 1 ? argv[1] : ""));
    if (argc > 3) {
      compare(connection, {argv[2], argv[3]});
      return EXIT_SUCCESS;
    }
    // validate_only: the server checks the fluid and does not store it, so that the program may run
    // any number of times.
    const v1::Lubricant fluid = connection.create(fluid_of_a_data_sheet(), "data-sheet", true);
    std::cout << fluid.display_name() << ": viscosity index "
              << fluid.characterisation().viscosity_index() << "\n";
    compare(connection, {"lubricants/paper-fluid-1", "lubricants/paper-fluid-2"});
    return EXIT_SUCCESS;
  } catch (const client::ServiceError& error) {
    std::cerr << error.what() << "\n";
    for (const client::FieldViolation& violation : error.violations()) {
      std::cerr << "  " << violation.field << "\n";
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
  }
  return EXIT_FAILURE;
}

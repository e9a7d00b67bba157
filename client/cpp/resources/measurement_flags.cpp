#include <cmath>
#include <optional>

#include "client/cpp/resources/edits.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

using google::protobuf::Message;

v1::LubricantMeasurements& measurements_of(Message& resource) {
  return *dynamic_cast<v1::Lubricant&>(resource).mutable_measurements();
}

/// Splits "-40C=150000mPas" into a temperature and the text of the value. Returns nullopt and adds
/// a complaint if that is not possible. `instead` names the flag for a value without temperature.
std::optional<std::pair<double, std::string>> split_pair(const std::string& flag,
                                                         const std::string& instead,
                                                         const std::string& text,
                                                         Complaints& complaints) {
  const std::size_t mark = text.find('=');
  const std::string start = flag + ": '" + printable(text) + "' ";
  if (mark == std::string::npos) {
    complaints.push_back(start + "must be TEMPERATURE=VALUE" +
                         (instead.empty() ? "" : "; did you mean " + instead + "?"));
    return std::nullopt;
  }
  std::string wrong;
  const auto temperature = read_quantity(text.substr(0, mark), "C", "C", true, wrong);
  if (!temperature) {
    complaints.push_back(start + "has no temperature before '='");
    return std::nullopt;
  }
  // 40 K is -233.15 C, not -233.14999999999998 C.
  return std::pair(std::round(*temperature * 1e9) / 1e9, text.substr(mark + 1));
}

/// `read` receives temperature and text of one value; it returns false and sets the error if it
/// cannot read them.
template <class Read>
void add_pair_flag(FlagList& flags, const std::string& name, const std::string& instead,
                   const char* field, const std::string& value_name, const std::string& description,
                   Read read) {
  Flag& flag = flags.raw(name, value_name, description);
  flag.is_repeatable = true;
  flag.field = field;
  flag.read = [name, instead, read](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) {
      const auto pair = split_pair(name, instead, text, complaints);
      if (!pair) continue;
      std::string wrong;
      if (!read(pair->first, pair->second, wrong)) {
        complaints.push_back(name + ": '" + printable(pair->second) + "' " + wrong);
      }
    }
  };
}

}  // namespace

void add_measurement_list_flags(FlagList& flags, ResourceEdits& edits) {
  add_pair_flag(flags, "--brookfield", "", "brookfield_viscosities", "T=mPa s",
                "Brookfield viscosity at low temperature (ASTM D2983), e.g. -40=150000 or "
                "-40C=150Pas; repeatable.",
                [&edits](double celsius, const std::string& text, std::string& wrong) {
                  const auto value = read_quantity(text, "mPa s", "mPa s", false, wrong);
                  if (!value) return false;
                  edits.add("measurements", [celsius, value](Message& resource) {
                    auto& entry = *measurements_of(resource).add_brookfield_viscosities();
                    entry.set_temperature_celsius(celsius);
                    entry.set_dynamic_viscosity_millipascal_seconds(*value);
                  });
                  return true;
                });
  add_pair_flag(flags, "--viscosity", "--kv40 or --kv100", "viscosities", "T=QUANTITY",
                "A viscosity, kinematic (20C=180mm2/s) or dynamic (20C=150mPas); repeatable; three "
                "or more temperatures determine T_0 of Vogel's law.",
                [&edits](double celsius, const std::string& text, std::string& wrong) {
                  const auto kinematic = read_quantity(text, "mm2/s", "", false, wrong);
                  const auto dynamic = read_quantity(text, "mPa s", "", false, wrong);
                  if (!kinematic && !dynamic) {
                    wrong = "must be a kinematic viscosity (mm2/s) or a dynamic one (mPa s)";
                    return false;
                  }
                  edits.add("measurements", [celsius, kinematic, dynamic](Message& resource) {
                    auto& entry = *measurements_of(resource).add_viscosities();
                    entry.set_temperature_celsius(celsius);
                    if (kinematic) {
                      entry.set_kinematic_viscosity_square_millimetres_per_second(*kinematic);
                    } else {
                      entry.set_dynamic_viscosity_millipascal_seconds(*dynamic);
                    }
                  });
                  return true;
                });
  add_pair_flag(flags, "--density", "--density15", "densities", "T=kg/m3",
                "A density at another temperature, e.g. 100=815; repeatable; two or more "
                "temperatures determine its slope.",
                [&edits](double celsius, const std::string& text, std::string& wrong) {
                  const auto value = read_quantity(text, "kg/m3", "kg/m3", false, wrong);
                  if (!value) return false;
                  edits.add("measurements", [celsius, value](Message& resource) {
                    auto& entry = *measurements_of(resource).add_densities();
                    entry.set_temperature_celsius(celsius);
                    entry.set_density_kilograms_per_cubic_metre(*value);
                  });
                  return true;
                });
}

void add_boundary_friction_flag(FlagList& flags, ResourceEdits& edits) {
  add_pair_flag(
      flags, "--asperity-friction-by-temperature", "--asperity-friction-coefficient",
      "asperity_friction_by_temperature", "T=COEFFICIENT",
      "Coefficient of boundary friction at a temperature of the contact inlet, e.g. 40=0.12, in "
      "place of --asperity-friction-coefficient; repeatable, by rising temperatures; linear "
      "between "
      "them.",
      [&edits](double celsius, const std::string& text, std::string& wrong) {
        const auto value = read_quantity(text, "", "", false, wrong);
        if (!value) return false;
        edits.add("asperity_friction_by_temperature", [celsius, value](Message& resource) {
          auto& entry =
              *dynamic_cast<v1::Lubricant&>(resource).add_asperity_friction_by_temperature();
          entry.set_temperature_celsius(celsius);
          entry.set_asperity_friction_coefficient(*value);
        });
        return true;
      });
}

}  // namespace tribodyn::client

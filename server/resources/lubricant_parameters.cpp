#include "server/resources/lubricant_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/lubricant/characterisation.h"
#include "core/lubricant/viscosity.h"
#include "core/lubricant/viscosity_index.h"
#include "core/refusal.h"
#include "server/mapping/from_core.h"
#include "server/mapping/to_core.h"
#include "server/resources/provenance.h"
#include "server/resources/viscosity_fit.h"
#include "server/support/lru_cache.h"
#include "server/support/value_of.h"

namespace tribodyn::server {
namespace {

using google::protobuf::FieldDescriptor;
using Stated = LubricantParameters<std::optional<KnownParameter>>;
using Known = LubricantParameters<KnownParameter>;

constexpr char kKinematic40[] = "kinematic_viscosity_40_celsius_square_millimetres_per_second";
constexpr char kKinematic100[] = "kinematic_viscosity_100_celsius_square_millimetres_per_second";
constexpr char kSheared100[] =
    "sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second";

constexpr double kFifteenCelsius = 15 + kZeroCelsius;
constexpr double kSquareMillimetres = 1e-6;
constexpr double kMillipascals = 1e-3;

/// The names of a parameter in the contract and in the core.
struct Member {
  const char* field;
  const char* name;
  std::optional<KnownParameter> Stated::*stated;
  KnownParameter Known::*known;
};

#define TRIBODYN_MEMBER(field, member) \
  { field, #member, &Stated::member, &Known::member }
constexpr Member kMembers[] = {
    TRIBODYN_MEMBER("vogel_viscosity_prefactor_pascal_seconds", vogel_viscosity_prefactor),
    TRIBODYN_MEMBER("vogel_temperature_coefficient_kelvin", vogel_temperature_coefficient),
    TRIBODYN_MEMBER("vogel_reference_temperature_kelvin", vogel_reference_temperature),
    TRIBODYN_MEMBER("pressure_viscosity_coefficient_per_pascal", pressure_viscosity_coefficient),
    TRIBODYN_MEMBER("pressure_viscosity_temperature_kelvin", pressure_viscosity_temperature),
    TRIBODYN_MEMBER("relaxation_time_seconds", relaxation_time),
    TRIBODYN_MEMBER("havriliak_negami_alpha", havriliak_negami_alpha),
    TRIBODYN_MEMBER("havriliak_negami_beta", havriliak_negami_beta),
    TRIBODYN_MEMBER("rheology_reference_temperature_kelvin", rheology_reference_temperature),
    TRIBODYN_MEMBER("limiting_shear_stress_at_zero_pressure_pascals",
                    limiting_shear_stress_at_zero_pressure),
    TRIBODYN_MEMBER("limiting_shear_stress_coefficient", limiting_shear_stress_coefficient),
    TRIBODYN_MEMBER("thermal_conductivity_watts_per_metre_kelvin", thermal_conductivity),
    TRIBODYN_MEMBER("density_at_zero_kelvin_kilograms_per_cubic_metre", density_at_zero_kelvin),
    TRIBODYN_MEMBER("density_slope_kilograms_per_cubic_metre_kelvin", density_temperature_slope)};
#undef TRIBODYN_MEMBER

const FieldDescriptor* descriptor(const Member& member) {
  return v1::Lubricant::descriptor()->FindFieldByName(member.field);
}

bool is_set(const v1::Lubricant& lubricant, const Member& member) {
  return lubricant.GetReflection()->HasField(lubricant, descriptor(member));
}

constexpr std::pair<Provenance, v1::Provenance> kProvenances[] = {
    {Provenance::kPublished, v1::PROVENANCE_PUBLISHED},
    {Provenance::kDerived, v1::PROVENANCE_DERIVED},
    {Provenance::kLiterature, v1::PROVENANCE_LITERATURE},
    {Provenance::kMeasured, v1::PROVENANCE_MEASURED},
    {Provenance::kFitted, v1::PROVENANCE_FITTED},
    {Provenance::kAssumed, v1::PROVENANCE_ASSUMED},
    {Provenance::kCalibrated, v1::PROVENANCE_CALIBRATED},
    {Provenance::kUser, v1::PROVENANCE_USER}};

constexpr std::pair<v1::Lubricant::BaseOilClass, BaseOilClass> kBaseOilClasses[] = {
    {v1::Lubricant::BASE_OIL_CLASS_GROUP_I, BaseOilClass::kGroupI},
    {v1::Lubricant::BASE_OIL_CLASS_GROUP_II, BaseOilClass::kGroupII},
    {v1::Lubricant::BASE_OIL_CLASS_GROUP_III, BaseOilClass::kGroupIII},
    {v1::Lubricant::BASE_OIL_CLASS_POLYALPHAOLEFIN, BaseOilClass::kPolyalphaolefin},
    {v1::Lubricant::BASE_OIL_CLASS_ESTER, BaseOilClass::kEster},
    {v1::Lubricant::BASE_OIL_CLASS_POLYALKYLENE_GLYCOL, BaseOilClass::kPolyalkyleneGlycol},
    {v1::Lubricant::BASE_OIL_CLASS_NAPHTHENIC, BaseOilClass::kNaphthenic}};

std::optional<double> stated_number(double value, double factor) {
  return value == 0 ? std::nullopt : std::optional<double>(value * factor);
}

/// Returns the density law that converts kinematic viscosities to dynamic ones. It comes from the
/// client's parameters, from measured densities, or from the class of the base oil, in this order.
DensityLaw density_law_of(const FluidMeasurements& fluid) {
  const Stated& stated = fluid.stated;
  if (stated.density_at_zero_kelvin && stated.density_temperature_slope) {
    return {stated.density_at_zero_kelvin->value, stated.density_temperature_slope->value, 0, 0, 0};
  }
  std::vector<DensityPoint> points = fluid.densities;
  if (fluid.density_15) points.insert(points.begin(), {kFifteenCelsius, *fluid.density_15});
  if (points.empty()) return density_law(estimate_density_15(fluid.base_oil).value, fluid.base_oil);
  return points.size() == 1 && fluid.density_15 ? density_law(*fluid.density_15, fluid.base_oil)
                                                : density_law(points, fluid.base_oil);
}

ViscosityPoint viscosity_point(const v1::ViscosityMeasurement& row, const DensityLaw* law) {
  const double temperature = row.temperature_celsius() + kZeroCelsius;
  double viscosity = row.dynamic_viscosity_millipascal_seconds() * kMillipascals;
  if (row.has_kinematic_viscosity_square_millimetres_per_second()) {
    viscosity = row.kinematic_viscosity_square_millimetres_per_second() * kSquareMillimetres *
                (law->density_at_zero_kelvin + law->slope * temperature);
  }
  return {temperature, viscosity, row.relative_standard_uncertainty()};
}

/// Measurements and parameters that the client entered, in the core's types, and the field of
/// LubricantMeasurements that each viscosity comes from.
struct Entered {
  FluidMeasurements fluid;
  std::string kinematic_viscosity_40_field = kKinematic40;
  std::string kinematic_viscosity_100_field = kKinematic100;
  std::vector<std::string> viscosity_fields;  ///< one for each row of fluid.viscosities

  std::string field(const GrossError& error) const {
    switch (error.measurement) {
      case Measurement::kKinematicViscosity40:
        return kinematic_viscosity_40_field;
      case Measurement::kKinematicViscosity100:
        return kinematic_viscosity_100_field;
      case Measurement::kShearedKinematicViscosity100:
        return kSheared100;
      case Measurement::kViscosity:
        return viscosity_fields[error.row];
      case Measurement::kColdViscosity:
        return fmt::format("brookfield_viscosities[{}].dynamic_viscosity_millipascal_seconds",
                           error.row);
    }
    return "";
  }
};

std::string field_of(const v1::ViscosityMeasurement& row, int index) {
  return fmt::format("viscosities[{}].{}", index,
                     row.has_kinematic_viscosity_square_millimetres_per_second()
                         ? "kinematic_viscosity_square_millimetres_per_second"
                         : "dynamic_viscosity_millipascal_seconds");
}

/// Uses a row of the table as KV40 or KV100 if it was measured at that temperature and the field
/// for that viscosity is unset. Returns false for all other rows.
bool take_as_standard_viscosity(const v1::ViscosityMeasurement& row, int index, Entered& out) {
  constexpr double kBathTolerance = 0.01;  // [K], tolerance of the bath temperature in ASTM D445
  if (!row.has_kinematic_viscosity_square_millimetres_per_second()) return false;
  if (row.relative_standard_uncertainty() != 0) return false;
  const auto take = [&](double celsius, std::optional<double>& viscosity, std::string& field) {
    if (std::abs(row.temperature_celsius() - celsius) > kBathTolerance || viscosity) return false;
    viscosity = row.kinematic_viscosity_square_millimetres_per_second() * kSquareMillimetres;
    field = field_of(row, index);
    return true;
  };
  return take(40, out.fluid.kinematic_viscosity_40, out.kinematic_viscosity_40_field) ||
         take(100, out.fluid.kinematic_viscosity_100, out.kinematic_viscosity_100_field);
}

/// Returns everything that the client entered in the core's types, without computed parameters.
/// Throws Refusal.
Entered entered(const v1::Lubricant& lubricant) {
  const v1::LubricantMeasurements& measured = lubricant.measurements();
  Entered result;
  FluidMeasurements& out = result.fluid;
  out.base_oil = value_of(kBaseOilClasses, lubricant.base_oil_class(), BaseOilClass::kUnspecified);
  out.kinematic_viscosity_40 = stated_number(
      measured.kinematic_viscosity_40_celsius_square_millimetres_per_second(), kSquareMillimetres);
  out.kinematic_viscosity_100 = stated_number(
      measured.kinematic_viscosity_100_celsius_square_millimetres_per_second(), kSquareMillimetres);
  out.sheared_kinematic_viscosity_100 = stated_number(
      measured.sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second(),
      kSquareMillimetres);
  out.density_15 = stated_number(measured.density_15_celsius_kilograms_per_cubic_metre(), 1);
  for (const v1::DensityMeasurement& row : measured.densities()) {
    out.densities.push_back(
        {row.temperature_celsius() + kZeroCelsius, row.density_kilograms_per_cubic_metre()});
  }
  for (const v1::BrookfieldViscosity& row : measured.brookfield_viscosities()) {
    out.cold_viscosities.push_back({row.temperature_celsius() + kZeroCelsius,
                                    row.dynamic_viscosity_millipascal_seconds() * kMillipascals,
                                    0});
  }
  for (const Member& member : kMembers) {
    if (!is_set(lubricant, member)) continue;
    const v1::ParameterProvenance* entry = find_provenance(lubricant.provenance(), member.field);
    if (entry != nullptr && entry->computed()) continue;
    KnownParameter known{lubricant.GetReflection()->GetDouble(lubricant, descriptor(member)),
                         {},
                         Provenance::kUser,
                         ""};
    if (entry != nullptr && entry->standard_uncertainty() > 0) {
      known.standard_uncertainty = entry->standard_uncertainty();
    }
    out.stated.*member.stated = known;
  }
  const Lubricant laws = to_core(lubricant);
  out.pressure_viscosity_law = laws.pressure_viscosity_law;
  out.law_parameters = laws.law_parameters;
  std::optional<DensityLaw> law;
  for (int i = 0; i < measured.viscosities_size(); ++i) {
    const v1::ViscosityMeasurement& row = measured.viscosities(i);
    if (take_as_standard_viscosity(row, i, result)) continue;
    if (row.has_kinematic_viscosity_square_millimetres_per_second() && !law) {
      law = density_law_of(out);
    }
    out.viscosities.push_back(viscosity_point(row, law ? &*law : nullptr));
    result.viscosity_fields.push_back(field_of(row, i));
  }
  return result;
}

/// Returns "lubricant.field", or an empty string if `name` is not a parameter.
std::string field_of_parameter(const std::string& name) {
  for (const Member& member : kMembers) {
    if (name == member.name) return member.field;
  }
  return {};
}

/// Returns the entry of a field; adds one if there is none.
v1::ParameterProvenance* entry_of(v1::Lubricant& lubricant, const std::string& field) {
  for (v1::ParameterProvenance& entry : *lubricant.mutable_provenance()) {
    if (entry.field() == field) return &entry;
  }
  v1::ParameterProvenance* entry = lubricant.add_provenance();
  entry->set_field(field);
  return entry;
}

void set_computed(v1::Lubricant& lubricant, const Member& member, const CharacterisedFluid& fluid) {
  const KnownParameter& known = fluid.parameters.*member.known;
  lubricant.GetReflection()->SetDouble(&lubricant, descriptor(member), known.value);
  v1::ParameterProvenance* entry = entry_of(lubricant, member.field);
  entry->set_provenance(value_of(kProvenances, known.provenance, v1::PROVENANCE_UNSPECIFIED));
  entry->set_source(known.source);
  entry->set_standard_uncertainty(known.standard_uncertainty.value_or(0));
  entry->set_computed(true);
  std::string warning;
  for (const CharacterisationWarning& each : fluid.warnings) {
    if (each.parameter == member.name) warning += (warning.empty() ? "" : " ") + each.sentence;
  }
  entry->set_warning(warning);
}

void add_residual(double temperature, double measured, const Lubricant& lubricant,
                  v1::LubricantCharacterisation& out) {
  v1::ViscosityResidual* row = out.add_viscosity_residuals();
  const double fitted = ambient_viscosity(lubricant, temperature);
  row->set_temperature_celsius(temperature - kZeroCelsius);
  row->set_measured_dynamic_viscosity_millipascal_seconds(measured / kMillipascals);
  row->set_fitted_dynamic_viscosity_millipascal_seconds(fitted / kMillipascals);
  row->set_residual(std::log(measured / fitted));
}

/// Adds the difference between each measured viscosity and the stored law.
void add_residuals(const FluidMeasurements& fluid, const Lubricant& lubricant,
                   v1::LubricantCharacterisation& out) {
  const auto add_kinematic = [&](const std::optional<double>& viscosity, double temperature) {
    if (!viscosity) return;
    add_residual(temperature, *viscosity * density(lubricant, temperature), lubricant, out);
  };
  add_kinematic(fluid.kinematic_viscosity_40, kFortyCelsius);
  add_kinematic(fluid.kinematic_viscosity_100, kHundredCelsius);
  for (const ViscosityPoint& row : fluid.viscosities) {
    add_residual(row.temperature, row.viscosity, lubricant, out);
  }
  for (const ViscosityPoint& row : fluid.cold_viscosities) {
    add_residual(row.temperature, row.viscosity, lubricant, out);
  }
  double squares = 0;
  for (const v1::ViscosityResidual& row : out.viscosity_residuals()) {
    squares += row.residual() * row.residual();
  }
  if (out.viscosity_residuals_size() > 0) {
    out.set_root_mean_square_residual(std::sqrt(squares / out.viscosity_residuals_size()));
  }
}

void add_figures(const CharacterisedFluid& fluid, v1::LubricantCharacterisation& out) {
  out.set_kinematic_viscosity_40_celsius_square_millimetres_per_second(
      fluid.kinematic_viscosity_40 / kSquareMillimetres);
  out.set_kinematic_viscosity_100_celsius_square_millimetres_per_second(
      fluid.kinematic_viscosity_100 / kSquareMillimetres);
  if (fluid.viscosity_index) out.set_viscosity_index(*fluid.viscosity_index);
  out.set_sae_j306_grade(fluid.grade.designation);
  out.set_sae_j306_grade_note(fluid.grade.note);
  out.set_temperature_of_150_pascal_seconds_celsius(fluid.temperature_of_150_pascal_seconds -
                                                    kZeroCelsius);
  out.set_expected_low_temperature_grade(fluid.expected_low_temperature_grade);
  for (const ViscosityLawComparison& each : fluid.walther_comparison) {
    v1::ViscosityLawComparison* row = out.add_walther_comparison();
    row->set_temperature_celsius(each.temperature - kZeroCelsius);
    row->set_walther_dynamic_viscosity_millipascal_seconds(each.walther_viscosity / kMillipascals);
    row->set_vogel_dynamic_viscosity_millipascal_seconds(each.vogel_viscosity / kMillipascals);
  }
  for (const CharacterisationWarning& each : fluid.warnings) {
    v1::CharacterisationWarning* row = out.add_warnings();
    row->set_code(each.code);
    row->set_field(field_of_parameter(each.parameter));
    row->set_sentence(each.sentence);
  }
  // Lubricants stored by a version without this check may have gross errors.
  for (const GrossError& each : fluid.gross_errors) {
    v1::CharacterisationWarning* row = out.add_warnings();
    row->set_code(each.code);
    row->set_sentence(each.sentence);
  }
}

v1::RangeWarning range_warning(const std::string& code, const std::string& sentence) {
  return to_message(RangeWarning{code, sentence});
}

std::vector<v1::RangeWarning> make_fluid_warnings(const v1::Lubricant& lubricant) {
  constexpr char kEstimated[] = "PARAMETER_ESTIMATED";
  std::vector<v1::RangeWarning> out;
  std::string estimated;
  try {
    const CharacterisedFluid fluid = characterise(entered(lubricant).fluid);
    for (const CharacterisationWarning& each : fluid.warnings) {
      if (each.code != kEstimated) {
        out.push_back(range_warning(each.code, each.sentence));
        continue;
      }
      std::string name = each.parameter;
      std::replace(name.begin(), name.end(), '_', ' ');
      estimated += (estimated.empty() ? "" : ", ") + name;
    }
    for (const GrossError& each : fluid.gross_errors) {
      out.push_back(range_warning(each.code, each.sentence));
    }
  } catch (const Refusal& refusal) {  // e.g. laws that do not reach 40 C
    out.push_back(range_warning(refusal.reason(), refusal.what()));
  }
  if (!estimated.empty()) {
    out.push_back(range_warning(kEstimated, "Not measured but estimated: " + estimated + "."));
  }
  return out;
}

}  // namespace

const FieldDescriptor* lubricant_parameter(const std::string& name) {
  const FieldDescriptor* field = v1::Lubricant::descriptor()->FindFieldByName(name);
  const bool is_number = field != nullptr && !field->is_repeated() && field->has_presence() &&
                         field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE;
  return is_number ? field : nullptr;
}

void check_law_of_pressure(const v1::Lubricant& lubricant, const std::string& path,
                           Violations& violations) {
  if (!lubricant.has_improved_yasutomi()) return;
  const auto check = [&](const char* field, bool is_set) {
    const v1::ParameterProvenance* entry = find_provenance(lubricant.provenance(), field);
    const bool is_computed = entry != nullptr && entry->field() == field && entry->computed();
    if (!is_set || is_computed) return;
    violations.add(join_path(path, field),
                   "{} is stated beside improved_yasutomi, which determines it; allowed: unset",
                   field);
  };
  check("pressure_viscosity_coefficient_per_pascal",
        lubricant.has_pressure_viscosity_coefficient_per_pascal());
  check("pressure_viscosity_temperature_kelvin",
        lubricant.has_pressure_viscosity_temperature_kelvin());
}

void complete_parameters(v1::Lubricant& lubricant, const std::string& path,
                         Violations& violations) {
  bool complete = true;
  for (const Member& member : kMembers) complete = complete && is_set(lubricant, member);
  if (complete && !lubricant.has_measurements()) return;
  try {
    const Entered stated = entered(lubricant);
    const CharacterisedFluid fluid = characterise(stated.fluid);
    for (const GrossError& error : fluid.gross_errors) {
      violations.add(join_path(path, "measurements." + stated.field(error)), error.sentence);
    }
    if (!fluid.gross_errors.empty()) return;
    for (const Member& member : kMembers) {
      if (!is_set(lubricant, member)) set_computed(lubricant, member, fluid);
    }
    // The measurements of a complete lubricant may allow no fit.
  } catch (const Refusal& refusal) {
    if (!complete) violations.add(path, refusal.what());
  }
}

void clear_computed_parameters(v1::Lubricant& lubricant) {
  auto& entries = *lubricant.mutable_provenance();
  for (int i = entries.size() - 1; i >= 0; --i) {
    if (!entries.Get(i).computed()) continue;
    const FieldDescriptor* field = lubricant_parameter(entries.Get(i).field());
    if (field == nullptr) continue;
    lubricant.GetReflection()->ClearField(&lubricant, field);
    entries.DeleteSubrange(i, 1);
  }
}

v1::LubricantCharacterisation characterisation(const v1::Lubricant& lubricant) {
  v1::LubricantCharacterisation out;
  const Lubricant laws = to_core(lubricant);
  const double measured = lubricant.measurements().density_15_celsius_kilograms_per_cubic_metre();
  out.set_density_15_celsius_kilograms_per_cubic_metre(
      measured == 0 ? density(laws, kFifteenCelsius) : measured);
  try {
    const FluidMeasurements fluid = entered(lubricant).fluid;
    add_residuals(fluid, laws, out);
    add_figures(characterise(fluid), out);
  } catch (const Refusal& refusal) {  // e.g. laws that do not reach 40 C
    v1::CharacterisationWarning* warning = out.add_warnings();
    warning->set_code(refusal.reason());
    warning->set_sentence(refusal.what());
  }
  return out;
}

std::optional<VogelFit> viscosity_fit(const v1::Lubricant& lubricant) {
  try {
    const FluidMeasurements fluid = entered(lubricant).fluid;
    if (fluid.stated.vogel_viscosity_prefactor) return std::nullopt;
    return characterise(fluid).viscosity_fit;
  } catch (const Refusal&) {
    return std::nullopt;
  }
}

std::vector<v1::RangeWarning> fluid_warnings(const v1::Lubricant& lubricant) {
  static LruCache<std::string, std::vector<v1::RangeWarning>> cache;
  return cache.get(lubricant.SerializeAsString(), [&] { return make_fluid_warnings(lubricant); });
}

v1::LubricantCharacterisation brief_characterisation(const v1::Lubricant& lubricant) {
  v1::LubricantCharacterisation out = characterisation(lubricant);
  out.clear_viscosity_residuals();
  out.clear_walther_comparison();
  out.clear_warnings();
  return out;
}

}  // namespace tribodyn::server

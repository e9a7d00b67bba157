#include <algorithm>
#include <utility>

#include "client/cpp/commands/resource_writes.h"
#include "client/cpp/resources/json_input.h"
#include "client/cpp/resources/row_columns.h"
#include "client/cpp/resources/table_files.h"
#include "client/cpp/text/csv.h"
#include "client/cpp/text/text.h"
#include "client/cpp/text/units.h"

namespace tribodyn::client {
namespace {

/// Returns the name with revision, e.g. "surfaces/run-in@3", however the resource was requested.
std::string revision_name(const google::protobuf::Message& resource) {
  const std::string name = text_field(resource, "name");
  const auto* revision = resource.GetDescriptor()->FindFieldByName("revision");
  return name.substr(0, name.find('@')) + "@" +
         std::to_string(resource.GetReflection()->GetInt32(resource, revision));
}

ResourcePointer send_with_tables(Connection& connection, const ResourceKind& kind,
                                 const google::protobuf::Message& resource, const std::string& id,
                                 const TableFiles& tables, bool validate_only) {
  if (!tables.viscosity_table.empty()) {
    v1::ImportLubricantRequest request;
    request.mutable_lubricant()->CopyFrom(resource);
    request.set_lubricant_id(id);
    request.set_viscosity_table_csv(read_table_file(tables.viscosity_table, kLargestTable));
    request.set_validate_only(validate_only);
    return std::make_unique<v1::Lubricant>(connection.import_lubricant(request));
  }
  if (!tables.tooth_contact.empty()) {
    v1::ImportGearSetRequest request;
    request.mutable_gear_set()->CopyFrom(resource);
    request.set_gear_set_id(id);
    request.set_tooth_contact_csv(read_table_file(tables.tooth_contact, kLargestTable));
    if (!tables.series.empty())
      request.set_series_csv(read_table_file(tables.series, kLargestTable));
    request.set_validate_only(validate_only);
    return std::make_unique<v1::GearSet>(connection.import_gear_set(request));
  }
  if (!tables.profiles.empty()) {
    v1::ImportSurfaceProfilesRequest request;
    request.mutable_surface()->CopyFrom(resource);
    request.set_surface_id(id);
    for (const TableFiles::Profile& table : tables.profiles) {
      *request.add_profiles() = profile_message(table);
    }
    request.set_levelling(tables.levelling);
    request.set_short_wave_cut_off_metres(tables.short_wave_cut_off_metres);
    request.set_long_wave_cut_off_metres(tables.long_wave_cut_off_metres);
    request.set_eq46_square_root_of_sum(tables.eq46_as_published);
    request.set_validate_only(validate_only);
    return std::make_unique<v1::Surface>(connection.import_surface_profiles(request));
  }
  if (tables.eq46_as_published) {
    throw Failure(kExitUsage, "--as-published applies to profiles: --profile is missing");
  }
  return kind.calls->create(connection, resource, id, validate_only);
}

void drop(v1::Lubricant& lubricant, std::initializer_list<const char*> fields) {
  for (const char* field : fields) {
    lubricant.GetReflection()->ClearField(&lubricant,
                                          v1::Lubricant::descriptor()->FindFieldByName(field));
    drop_provenance(lubricant, field);
  }
}

/// Clears all viscosities of the copied lubricant: the table of viscosities is of another fluid.
void clear_viscosities(v1::Lubricant& lubricant) {
  drop(lubricant, {"vogel_viscosity_prefactor_pascal_seconds",
                   "vogel_temperature_coefficient_kelvin", "vogel_reference_temperature_kelvin"});
  v1::LubricantMeasurements& measured = *lubricant.mutable_measurements();
  measured.clear_kinematic_viscosity_40_celsius_square_millimetres_per_second();
  measured.clear_kinematic_viscosity_100_celsius_square_millimetres_per_second();
  measured.clear_sheared_kinematic_viscosity_100_celsius_square_millimetres_per_second();
  measured.clear_brookfield_viscosities();
  measured.clear_viscosities();
}

void clear_densities(v1::Lubricant& lubricant) {
  drop(lubricant, {"density_at_zero_kelvin_kilograms_per_cubic_metre",
                   "density_slope_kilograms_per_cubic_metre_kelvin"});
  lubricant.mutable_measurements()->clear_density_15_celsius_kilograms_per_cubic_metre();
  lubricant.mutable_measurements()->clear_densities();
}

bool has_densities(const std::string& path) {
  const std::string text = read_table_file(path, kLargestTable);
  const std::vector<CsvLine> lines = read_csv(text, 1);
  return !lines.empty() &&
         std::any_of(lines[0].cells.begin(), lines[0].cells.end(), [](const std::string& cell) {
           const std::string word = plain_word(cell);
           return word.starts_with("density") || word.starts_with("rho");
         });
}

void replace_all(const std::string& from, const std::string& to, std::string& text) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

}  // namespace

bool read_profile(const std::string& text, TableFiles::Profile& profile) {
  std::vector<std::string> parts = split(text, ',');
  if (parts.empty()) return false;
  profile.path = parts.back();
  parts.pop_back();
  for (const std::string& part : parts) {
    if (part == "pinion") {
      profile.member = v1::FLANK_MEMBER_PINION;
    } else if (part == "gear") {
      profile.member = v1::FLANK_MEMBER_GEAR;
    } else if (part == "axial") {
      profile.direction = v1::PROFILE_DIRECTION_AXIAL;
    } else if (part == "radial") {
      profile.direction = v1::PROFILE_DIRECTION_RADIAL;
    } else {
      return false;
    }
  }
  return !profile.path.empty();
}

v1::SurfaceProfile profile_message(const TableFiles::Profile& profile) {
  v1::SurfaceProfile out;
  out.set_member(profile.member);
  out.set_direction(profile.direction);
  out.set_csv(read_table_file(profile.path, kLargestTable));
  return out;
}

ServiceError with_file_names(const ServiceError& error, const TableFiles& tables) {
  std::vector<std::pair<std::string, std::string>> names = {
      {"viscosity_table_csv", tables.viscosity_table},
      {"tooth_contact_csv", tables.tooth_contact},
      {"series_csv", tables.series}};
  for (std::size_t i = 0; i < tables.profiles.size(); ++i) {
    names.emplace_back("profiles[" + std::to_string(i) + "].csv", tables.profiles[i].path);
  }
  std::string text = error.what();
  std::vector<FieldViolation> violations = error.violations();
  for (const auto& [field, path] : names) {
    if (path.empty()) continue;
    replace_all(field, printable(path), text);
    for (FieldViolation& each : violations) replace_all(field, printable(path), each.field);
  }
  return {text, error.status_code(), error.reason(), violations, error.retry_delay_seconds()};
}

namespace {

/// Adds the cut-off of a filter; a bare number is in `bare_unit`.
void add_cut_off_flag(FlagList& flags, const char* name, const char* bare_unit,
                      const std::string& description, double& cut_off) {
  Flag& flag = flags.raw(name, bare_unit,
                         description + " (Gaussian filter, ISO 16610-21). Default: no filter.");
  flag.bare_unit = bare_unit;
  flag.read = [name, bare_unit, &cut_off](const std::vector<std::string>& texts,
                                          Complaints& complaints) {
    std::string wrong;
    const auto value = read_quantity(texts.back(), "m", bare_unit, false, wrong);
    if (value) {
      cut_off = *value;
    } else {
      complaints.push_back(std::string(name) + ": '" + printable(texts.back()) + "' " + wrong);
    }
  };
}

}  // namespace

void add_profile_flags(FlagList& flags, const char* name, TableFiles& tables) {
  Flag& profile = flags.raw(name, "[pinion|gear,][axial|radial,]FILE.csv",
                            "A measured profile of a flank; repeatable. Several of one flank "
                            "along one direction are averaged.");
  profile.is_repeatable = true;
  profile.read = [name, &tables](const std::vector<std::string>& texts, Complaints& complaints) {
    for (const std::string& text : texts) {
      if (!read_profile(text, tables.profiles.emplace_back())) {
        complaints.push_back(std::string(name) + ": '" + printable(text) +
                             "' is not [pinion|gear,][axial|radial,]FILE");
      }
    }
  };
  flags.choice("--levelling", {"mean", "least-squares-line"},
               "Trend that is removed from a profile before the statistics. Default: "
               "least-squares-line.",
               [&tables](int index) {
                 tables.levelling =
                     index == 0 ? v1::LEVELLING_MEAN : v1::LEVELLING_LEAST_SQUARES_LINE;
               });
  add_cut_off_flag(flags, "--lambda-s", "um",
                   "Remove waves shorter than this (noise of the instrument), e.g. 2.5",
                   tables.short_wave_cut_off_metres);
  add_cut_off_flag(flags, "--lambda-c", "mm",
                   "Remove waves longer than this (waviness and form), e.g. 0.8",
                   tables.long_wave_cut_off_metres);
  flags.choice("--as-published", {"eq46"},
               "Join two directions of a flank by eq 46 as the paper misprints it, sqrt(m_a + m_r) "
               "instead of sqrt(m_a m_r), to see its effect.",
               [&tables](int) { tables.eq46_as_published = true; });
}

void add_table_flags(FlagList& flags, const ResourceKind& kind, TableFiles& tables) {
  flags.group("Tables (CSV; `tribodyn help files` describes their columns)");
  if (kind.word == "lubricants") {
    flags.text("--viscosity-table", "FILE.csv",
               "Viscosities, and densities if known, at several temperatures.",
               [&](const std::string& path) { tables.viscosity_table = path; });
  } else if (kind.word == "gear-sets") {
    flags.text("--tooth-contact", "FILE.csv",
               "Tooth contact data of another program, by roll or by mesh phase and slot.",
               [&](const std::string& path) { tables.tooth_contact = path; });
    flags.text("--series", "FILE.csv",
               "Fourier series of contact radii, mesh stiffness and transmission error.",
               [&](const std::string& path) { tables.series = path; });
  } else if (kind.word == "surfaces") {
    add_profile_flags(flags, "--profile", tables);
  }
}

void add_table(const ResourceKind& kind, const std::string& path, TableFiles& tables) {
  if (kind.word == "lubricants") {
    tables.viscosity_table = path;
  } else if (kind.word == "gear-sets") {
    tables.tooth_contact = path;
  } else if (kind.word == "surfaces") {
    tables.profiles.emplace_back().path = path;
  } else {
    throw Failure(kExitUsage, path + ": no tables exist for " + kind.plural);
  }
}

ResourcePointer copy_of(Connection& connection, const ResourceKind& kind, const std::string& name,
                        const TableFiles& tables) {
  ResourcePointer resource = kind.calls->get(connection, kind.name_of(name));
  const std::string origin = revision_name(*resource);
  clear_output_only(*resource);
  for (auto& entry : provenance_entries_of(*resource)) {
    if (!entry.computed()) entry.set_source("as in " + origin);
  }
  const auto clear = [&](std::initializer_list<const char*> fields) {
    for (const char* field : fields) {
      resource->GetReflection()->ClearField(resource.get(),
                                            resource->GetDescriptor()->FindFieldByName(field));
    }
  };
  clear({"name", "derived_from", "display_name", "description"});
  if (auto* lubricant = dynamic_cast<v1::Lubricant*>(resource.get());
      lubricant != nullptr && !tables.viscosity_table.empty()) {
    clear_viscosities(*lubricant);
    if (has_densities(tables.viscosity_table)) clear_densities(*lubricant);
  }
  if (!tables.tooth_contact.empty()) {
    clear({"flank_slots", "series_by_torque", "load_share_by_torque"});
  }
  if (!tables.series.empty()) clear({"series"});
  if (!tables.profiles.empty()) {
    clear({"measurements", "asperity_density_per_square_metre", "asperity_radius_metres",
           "composite_rms_height_metres"});
    for (const char* field : {"asperity_density_per_square_metre", "asperity_radius_metres",
                              "composite_rms_height_metres"}) {
      drop_provenance(*resource, field);
    }
  }
  return resource;
}

ResourcePointer create_with_tables(Connection& connection, const ResourceKind& kind,
                                   const google::protobuf::Message& resource, const std::string& id,
                                   const TableFiles& tables, bool validate_only) {
  try {
    return send_with_tables(connection, kind, resource, id, tables, validate_only);
  } catch (const ServiceError& error) {
    if (error.kind() != ServiceError::Kind::kRefused) throw;
    throw with_file_names(error, tables);
  }
}

}  // namespace tribodyn::client
